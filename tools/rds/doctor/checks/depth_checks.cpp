// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/depth_checks.hpp"

#include <string>

#include <fmt/format.h>

#include "tools/evaluation/statistics.hpp"
#include "tools/rds/doctor/checks/frame_share.hpp"

namespace rds::doctor {
namespace {
using evaluation::percentile;

constexpr double kFewest = 0.3;      // share of measured pixels
constexpr double kOneValue = 0.8;    // share of the commonest value
constexpr double kSaturated = 0.02;  // the same for the greatest value a picture can hold
constexpr double kGreatestRaw = 65535;

/// Depth [m] of a whole recording: the median frame's 1st, 50th and 99th percentile.
struct Range {
  double near_m = 0;
  double median_m = 0;
  double far_m = 0;
};

Range range_of(const std::vector<FrameLook>& frames) {
  std::vector<double> near;
  std::vector<double> median;
  std::vector<double> far;
  for (const auto& frame : frames)
    if (frame.depth.median_m > 0) {
      near.push_back(frame.depth.near_m);
      median.push_back(frame.depth.median_m);
      far.push_back(frame.depth.far_m);
    }
  if (near.empty()) return {};
  return {percentile(near, 50), percentile(median, 50), percentile(far, 50)};
}

bool cannot_be(const Range& range) {
  return range.median_m < 0.15 || range.median_m > 20;
}

/// Too near or too far for a sensor that measures rooms: as a rule the depth of another scale.
bool is_odd(const Range& range) {
  const bool near = range.near_m < 0.35 && range.far_m < 1.2;
  const bool far = range.near_m > 2.5 && range.far_m > 9;
  return near || far || cannot_be(range);
}

std::string plausible_scales(const Range& range, double depth_scale) {
  std::string text;
  for (const double other : {1.0, 100.0, 1000.0, 5000.0, 10000.0}) {
    const double factor = depth_scale / other;
    const Range seen{range.near_m * factor, range.median_m * factor, range.far_m * factor};
    if (other != depth_scale && seen.near_m > 0.25 && seen.far_m < 12)
      text += fmt::format("; with {:g} it would be {:.2f} m", other, seen.median_m);
  }
  return text;
}

}  // namespace

Finding check_depth_scale(const std::vector<FrameLook>& frames, double depth_scale) {
  const Range range = range_of(frames);
  if (range.median_m <= 0) return {Verdict::kFault, "depth scale", "no depth picture holds a measurement"};
  const auto text = fmt::format("depth_scale {:g} makes depth {:.2f} m in the median ({:.2f} … {:.2f} m)",
                                depth_scale, range.median_m, range.near_m, range.far_m);
  if (!is_odd(range)) return {Verdict::kGood, "depth scale", text};
  return {cannot_be(range) ? Verdict::kFault : Verdict::kHint, "depth scale",
          text + (cannot_be(range) ? ", which cannot be" : ", which is unusual in a room") +
              plausible_scales(range, depth_scale)};
}

Finding check_depth_share(const std::vector<FrameLook>& frames) {
  return share_of(frames, "depth",
                  fmt::format("have depth at less than {:.0f} % of the pixels", 100 * kFewest),
                  [](const auto& f) { return f.depth.measured < kFewest; });
}

Finding check_depth_values(const std::vector<FrameLook>& frames) {
  const auto is_bad = [](const auto& f) {
    const bool saturated = f.depth.commonest_raw >= kGreatestRaw && f.depth.commonest > kSaturated;
    return saturated || f.depth.commonest > kOneValue;
  };
  const auto first = std::ranges::find_if(frames, is_bad);
  const double value = first == frames.end() ? 0 : first->depth.commonest_raw;
  return share_of(frames, "depth values",
                  fmt::format("hold one value, {:g}, in too many places (no measurement is 0)", value),
                  is_bad);
}

Finding check_depth_frozen(const std::vector<FrameLook>& frames) {
  return share_of(frames, "frozen depth", "repeat the depth picture before",
                  [](const auto& f) { return f.depth_repeated; });
}

}  // namespace rds::doctor
