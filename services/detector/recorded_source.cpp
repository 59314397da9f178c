// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "services/detector/core/box_depth.hpp"
#include "services/detector/detection_source.hpp"

namespace rds::detector {
namespace {

using nlohmann::json;

constexpr std::int64_t kStampToleranceNs = 5'000'000;

/// A stamp given as a number or as text [s].
std::int64_t stamp_of(const json& value) {
  const double seconds = value.is_string() ? std::stod(value.get<std::string>()) : value.get<double>();
  if (!(seconds >= 0 && seconds < 1e10)) throw std::out_of_range("stamp");
  return static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

Detection detection_of(const json& value, const std::string& label, const char* depth_key) {
  const auto& box = value.at("box");
  return {.label = label,
          .score = value.value("score", 1.0F),
          .box = {box.at(0).get<double>(), box.at(1).get<double>(), box.at(2).get<double>(),
                  box.at(3).get<double>()},
          .depth_m = value.value(depth_key, 0.0F)};
}

/// One line of detections.jsonl.
void read_line(const json& line, std::map<std::int64_t, std::vector<Detection>>& by_stamp) {
  auto& detections = by_stamp[stamp_of(line.at("stamp"))];
  for (const json& d : line.at("detections"))
    detections.push_back(detection_of(d, d.at("label").get<std::string>(), "depth_m"));
}

void read_truth(const json& truth, std::map<std::int64_t, std::vector<Detection>>& by_stamp) {
  for (const json& frame : truth.at("frames")) {
    auto& detections = by_stamp[stamp_of(frame.at("timestamp"))];
    for (const json& person : frame.at("people"))
      detections.push_back(detection_of(person, person.value("label", "person"), "distance"));
  }
}

}  // namespace

RecordedSource::RecordedSource(const std::filesystem::path& file, double max_depth_m)
    : max_depth_m_(max_depth_m) {
  std::ifstream in(file);
  if (!in) throw DetectorError(fmt::format("{}: cannot be read", file.string()));
  int number = 0;
  try {
    if (file.extension() == ".json") {
      read_truth(json::parse(in), by_stamp_);
      return;
    }
    for (std::string line; std::getline(in, line);) {
      ++number;
      if (!line.empty()) read_line(json::parse(line), by_stamp_);
    }
  } catch (const std::exception& e) {
    throw DetectorError(fmt::format(
        "{}:{}: {}, expected detections as in detections.jsonl, or people.json with frames and people",
        file.string(), number, e.what()));
  }
}

std::vector<Detection> RecordedSource::detections(const image::RgbdFrame& frame) {
  auto record = by_stamp_.lower_bound(frame.stamp_ns - kStampToleranceNs);
  if (record == by_stamp_.end() || record->first > frame.stamp_ns + kStampToleranceNs) return {};
  const auto next = std::next(record);
  if (next != by_stamp_.end() &&
      std::abs(next->first - frame.stamp_ns) < std::abs(record->first - frame.stamp_ns))
    record = next;
  std::vector<Detection> detections = record->second;
  for (Detection& d : detections)
    if (!(d.depth_m > 0)) d.depth_m = box_depth(frame.depth, d.box, max_depth_m_);
  return detections;
}

}  // namespace rds::detector
