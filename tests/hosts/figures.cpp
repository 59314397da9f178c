// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/figures.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "tests/integration/run_support.hpp"
#include "tools/evaluation/map_score.hpp"

namespace rds::test {
namespace {

const std::string kChunksTo = "rds/transfer/";  // the reader
constexpr const char* kSent = "transfer chunks sent";
constexpr const char* kSentAgain = "transfer chunks sent again";

double per(double part, std::size_t whole) {
  return whole == 0 ? 0 : part / static_cast<double>(whole);
}

}  // namespace

double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

void add_transfer(const std::map<std::string, std::string>& statuses, HostFigures& figures) {
  double sent = 0;
  double again = 0;
  double most_bytes = 0;
  for (const auto& [service, text] : statuses) {
    const auto status = nlohmann::json::parse(text, nullptr, false);
    if (!status.is_object() || !status.contains("endpoints")) continue;
    for (const auto& endpoint : status["endpoints"]) {
      const auto topic = endpoint.value("topic", "");
      if (endpoint.value("publisher", true) || !topic.starts_with(kChunksTo) || topic.ends_with("offers"))
        continue;
      if (topic.ends_with("requests")) continue;  // the tracker reads them
      most_bytes = std::max(most_bytes, endpoint.value("bytes", 0.0));
    }
    const auto said = status.value("figures", nlohmann::json::object());
    sent += std::stod(said.value(kSent, "0"));
    again += std::stod(said.value(kSentAgain, "0"));
  }
  figures.repeats = sent > 0 ? again / sent : 0;
  figures.reader_bytes = per(most_bytes, figures.keyframes);
}

void add_scores(const RecordingPair& recording, const std::filesystem::path& out,
                const std::filesystem::path& seen_by, HostFigures& figures) {
  const auto path = score(recording.dataset, out);
  figures.ate_live_m = path["ate_live"].get<double>();
  figures.ate_final_m = path["ate_final"].get<double>();
  if (!std::filesystem::exists(out / "map.ot")) return;
  const auto map = evaluation::score_map(
      {.dataset = recording.dataset, .background = recording.background, .out = out, .seen_by = seen_by});
  if (!map) throw std::runtime_error(map.error());
  figures.recall = map->static_recall;
  figures.residue = map->residue ? map->residue->residue : 0;
}

std::string to_line(const std::string& label, const HostFigures& f, const HostFigures& one) {
  return fmt::format(
      "{:<28} answered {} of {} ({:.3f}), p50 {:.0f} p95 {:.0f} ms ({:.0f} {:.0f}), gap {:.2f} s ({:.2f}), "
      "ATE live {:.4f} ({:.4f}) final {:.4f} ({:.4f}) m, recall {:.3f} ({:.3f}), residue {:.4f} ({:.4f}), "
      "missing {}, link {:.0f} kB, reader {:.0f} kB a keyframe, repeats {:.3f}, localised {} of {}, total "
      "p99 "
      "{:.1f} ms",
      label, f.answered, f.keyframes, f.share_answered(), f.p50_ms, f.p95_ms, one.p50_ms, one.p95_ms,
      f.longest_gap_s, one.longest_gap_s, f.ate_live_m, one.ate_live_m, f.ate_final_m, one.ate_final_m,
      f.recall, one.recall, f.residue, one.residue, f.missing, f.link_bytes / 1e3, f.reader_bytes / 1e3,
      f.repeats, f.localized, f.frames, f.p99_total_ms);
}

}  // namespace rds::test
