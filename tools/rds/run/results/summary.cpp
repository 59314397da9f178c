// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/results/summary.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/evaluation/statistics.hpp"

namespace rds::run {
namespace {

using evaluation::percentile;
using nlohmann::ordered_json;

double rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

ordered_json distribution(const Recording& recording, double FrameRecord::*field) {
  std::vector<double> values;
  for (const auto& [stamp, frame] : recording.frames) values.push_back(frame.*field);
  if (values.empty()) values.push_back(0);
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {{"mean", rounded(sum / static_cast<double>(values.size()))},
          {"median", rounded(percentile(values, 50))},
          {"p95", rounded(percentile(values, 95))},
          {"p99", rounded(percentile(values, 99))}};
}

ordered_json frames_json(const SummaryInput& in) {
  std::size_t tracked = 0;
  std::size_t lost = 0;
  std::size_t in_submaps = 0;
  std::size_t keyframes = 0;
  for (const auto& [stamp, frame] : in.recording.frames) {
    tracked += frame.has_pose ? 1U : 0U;
    in_submaps += frame.is_in_submap ? 1U : 0U;
    lost += frame.has_pose || frame.is_in_submap ? 0U : 1U;
    keyframes += frame.is_keyframe ? 1U : 0U;
  }
  return {{"in_dataset", in.frames_in_dataset},
          {"played", in.player.played},
          {"unreadable", in.player.unreadable},
          {"tracked", tracked},
          {"lost", lost},
          {"in_submaps", in_submaps},
          {"dropped", in.player.played - std::min(in.player.played, in.recording.frames.size())},
          {"keyframes", keyframes},
          {"keyframes_in_map", in.recording.keyframes_in_map}};
}

ordered_json processes_json(const SummaryInput& in) {
  ordered_json processes = ordered_json::object();
  for (const auto& [name, used] : in.usage)
    processes[name] = {{"cpu_s", rounded(used.cpu_s)},
                       {"peak_rss_mb", rounded(static_cast<double>(used.peak_bytes) / 1e6)},
                       {"restarts", used.restarts},
                       {"failures", used.failures}};
  return processes;
}

/// How far the detector is behind: from the arrival of a keyframe to its boxes, and keyframes never looked
/// at.
ordered_json detector_json(const SummaryInput& in) {
  const auto text = in.status.find("rds-detector");
  if (text == in.status.end()) return nullptr;
  const auto status = nlohmann::json::parse(text->second, nullptr, false);
  if (!status.is_object() || !status.contains("figures")) return nullptr;
  const auto figure = [&](const char* name) { return std::stod(status["figures"].value(name, "0")); };
  return {{"lag_ms", {{"median", figure("lag p50 [ms]")}, {"p99", figure("lag p99 [ms]")}}},
          {"keyframes_skipped", static_cast<std::uint64_t>(figure("keyframes skipped"))}};
}

/// How far the map was behind while the camera ran: from a keyframe to the map that has it, and keyframes
/// that it never got.
ordered_json map_json(const SummaryInput& in) {
  const auto answer = nlohmann::json::parse(in.map_description, nullptr, false);
  if (!answer.is_object()) return nullptr;
  const std::size_t made = in.options.localize_only ? 0 : in.recording.keyframes.size();
  const std::size_t mapped = answer.value("keyframes", std::size_t{0});
  ordered_json json{{"keyframes", mapped}, {"keyframes_missing", made - std::min(made, mapped)}};
  if (const auto& delays = in.recording.map_delays_s; !delays.empty())
    json["delay_s"] = {{"median", rounded(percentile(delays, 50))}, {"p99", rounded(percentile(delays, 99))}};
  return json;
}

/// Messages and bytes written per topic, by all services; what is dropped anywhere is dropped.
ordered_json topics_json(const SummaryInput& in) {
  std::map<std::string, std::array<std::uint64_t, 3>> topics;
  for (const auto& [service, text] : in.status) {
    const auto status = nlohmann::json::parse(text, nullptr, false);
    if (!status.is_object() || !status.contains("endpoints")) continue;
    for (const auto& endpoint : status["endpoints"]) {
      auto& [messages, bytes, dropped] = topics[endpoint.value("topic", "")];
      dropped += endpoint.value("dropped", std::uint64_t{0});
      if (!endpoint.value("publisher", false)) continue;
      messages += endpoint.value("messages", std::uint64_t{0});
      bytes += endpoint.value("bytes", std::uint64_t{0});
    }
  }
  ordered_json json = ordered_json::object();
  for (const auto& [topic, counts] : topics)
    json[topic] = {{"messages", counts[0]}, {"bytes", counts[1]}, {"dropped", counts[2]}};
  return json;
}

}  // namespace

ordered_json summarize(const SummaryInput& in) {
  ordered_json json{
      {"version", RDS_VERSION},
      {"dataset", in.options.dataset.string()},
      {"rate", in.options.lockstep() ? ordered_json("max") : ordered_json(in.options.rate)},
      {"dynamics", in.options.dynamics},
      {"poses", in.options.poses.empty() ? "estimated" : in.options.poses.string()},
      {"frames", frames_json(in)},
      {"total_ms", distribution(in.recording, &FrameRecord::total_ms)},
      {"extract_ms", distribution(in.recording, &FrameRecord::extract_ms)},
      {"track_ms", distribution(in.recording, &FrameRecord::track_ms)},
      {"predict_ms", distribution(in.recording, &FrameRecord::predict_ms)},
      {"loops_closed", in.recording.loops_closed},
      {"wall_s", rounded(in.wall_s)},
      {"frames_per_s", rounded(static_cast<double>(in.player.played) / std::max(in.wall_s, 1e-9))}};
  if (in.ate_live_m) json["ate_live"] = rounded(*in.ate_live_m);
  if (in.ate_final_m) json["ate_final"] = rounded(*in.ate_final_m);
  json["bus"] = ordered_json::object();
  for (const auto& [name, used] : in.usage) json["bus"][name] = bus::name_of(in.options.vendor_of(name));
  if (const ordered_json detector = detector_json(in); !detector.is_null()) json["detector"] = detector;
  if (const ordered_json map = map_json(in); !map.is_null()) json["map"] = map;
  json["processes"] = processes_json(in);
  json["topics"] = topics_json(in);
  return json;
}

}  // namespace rds::run
