// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/list_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "common/geometry/association.hpp"
#include "common/geometry/stamp.hpp"
#include "tools/evaluation/statistics.hpp"

namespace rds::doctor {
namespace {
using evaluation::percentile;

constexpr double kMs = 1e-6;                 // nanoseconds to milliseconds
constexpr double kFewDegreesPerSecond = 30;  // a camera turned by hand
constexpr double kFarApart = 0.25;           // of the frame period
constexpr double kRateTolerance = 0.1;       // of camera.yaml's rate
constexpr double kUneven = 0.25;             // off the median interval
constexpr double kUnevenShare = 0.05;        // of the intervals
constexpr double kGapFactor = 3;             // median intervals
constexpr double kLongGapMs = 500;           // a camera in a hand may have moved out of sight
constexpr double kBadShare = 0.1;            // of the pictures: more is a fault
constexpr std::int64_t kTruthToleranceNs = 20'000'000;

std::vector<double> intervals_ms(const RecordingLists& lists) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < lists.frames.size(); ++i)
    intervals.push_back(static_cast<double>(lists.frames[i] - lists.frames[i - 1]) * kMs);
  return intervals;
}

Verdict by_share(std::size_t bad, std::size_t all) {
  if (bad == 0) return Verdict::kGood;
  return static_cast<double>(bad) > kBadShare * static_cast<double>(all) ? Verdict::kFault : Verdict::kHint;
}

}  // namespace

Finding check_counts(const RecordingLists& lists) {
  const std::size_t without_depth = lists.frames.size() - lists.depth_after.size();
  Verdict verdict = by_share(without_depth, lists.frames.size());
  if (verdict == Verdict::kGood && lists.repeated > 0) verdict = Verdict::kHint;
  return {
      verdict, "frames",
      fmt::format("{} colour and {} depth pictures; colour pictures without depth within 20 ms: {}, stamps "
                  "given twice: {}",
                  lists.frames.size(), lists.depth_pictures, without_depth, lists.repeated)};
}

Finding check_files(const RecordingLists& lists) {
  const std::size_t listed = lists.frames.size() + lists.depth_pictures;
  if (lists.missing.empty())
    return {Verdict::kGood, "files", fmt::format("all {} listed pictures are there", listed)};
  return {by_share(lists.missing.size(), listed), "files",
          fmt::format("{} of {} listed pictures are missing, the first is {}", lists.missing.size(), listed,
                      lists.missing.front().string())};
}

Finding check_pairing(const RecordingLists& lists, double focal_px) {
  std::vector<double> offsets;
  for (const auto offset : lists.depth_after) offsets.push_back(static_cast<double>(std::abs(offset)) * kMs);
  const double median = percentile(offsets, 50);
  auto text = fmt::format("depth {:.1f} ms from colour in the median, {:.1f} ms at most", median,
                          percentile(offsets, 100));
  const double pixels = focal_px * kFewDegreesPerSecond * std::numbers::pi / 180 * median / 1000;
  const bool far = median > kFarApart * percentile(intervals_ms(lists), 50);
  if (far)
    text += fmt::format("; not synchronised: {:.0f} px off when the camera turns at {:g}°/s", pixels,
                        kFewDegreesPerSecond);
  return {far ? Verdict::kHint : Verdict::kGood, "pairing", text};
}

Finding check_rate(const RecordingLists& lists, double fps) {
  const auto intervals = intervals_ms(lists);
  if (intervals.empty()) return {Verdict::kFault, "frame rate", "only one frame, nothing can be tracked"};
  const double median = percentile(intervals, 50);
  const auto uneven =
      std::ranges::count_if(intervals, [&](double ms) { return std::abs(ms / median - 1) > kUneven; });
  const double share = static_cast<double>(uneven) / static_cast<double>(intervals.size());
  const bool other = std::abs(1000 / median / fps - 1) > kRateTolerance;
  return {
      other || share > kUnevenShare ? Verdict::kHint : Verdict::kGood, "frame rate",
      fmt::format("{:.1f} frames/s in the median (camera.yaml: {:g}), {:.1f} % of the intervals are uneven",
                  1000 / median, fps, 100 * share)};
}

Finding check_gaps(const RecordingLists& lists) {
  const auto intervals = intervals_ms(lists);
  const double limit = kGapFactor * percentile(intervals, 50);
  const auto gaps = std::ranges::count_if(intervals, [&](double ms) { return ms > limit; });
  if (gaps == 0) return {Verdict::kGood, "gaps", "none"};
  const auto longest = std::ranges::max_element(intervals);
  return {*longest > kLongGapMs ? Verdict::kFault : Verdict::kHint, "gaps",
          fmt::format(
              "{} of more than {:.0f} ms, the longest {:.0f} ms after {} s", gaps, limit, *longest,
              geometry::format_stamp(lists.frames[static_cast<std::size_t>(longest - intervals.begin())]))};
}

Finding check_truth(const RecordingLists& lists) {
  if (!lists.truth) return {Verdict::kHint, "ground truth", "no groundtruth.txt: no error can be computed"};
  const auto pairs = geometry::associate<std::int64_t>(lists.frames, *lists.truth, kTruthToleranceNs);
  const Verdict verdict = pairs.empty()                                 ? Verdict::kFault
                          : 10 * pairs.size() < 9 * lists.frames.size() ? Verdict::kHint
                                                                        : Verdict::kGood;
  return {verdict, "ground truth",
          fmt::format("{} poses; {} of {} frames have one within 20 ms", lists.truth->size(), pairs.size(),
                      lists.frames.size())};
}

}  // namespace rds::doctor
