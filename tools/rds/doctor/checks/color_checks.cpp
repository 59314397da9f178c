// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/color_checks.hpp"

#include <algorithm>
#include <cmath>

#include "tools/evaluation/statistics.hpp"
#include "tools/rds/doctor/checks/frame_share.hpp"

namespace rds::doctor {
namespace {
using evaluation::percentile;

constexpr double kFrozenChange = 0.05;  // grey levels; sensor noise alone gives more
constexpr double kLessSharp = 0.25;     // of the recording's median
constexpr double kSoft = 0.003;         // sharpness; out of focus by σ = 2 px gives 0.001 to 0.0025
constexpr double kDark = 25;            // grey levels
constexpr double kBright = 235;
constexpr double kFlat = 6;          // grey levels
constexpr double kJumpShare = 0.15;  // of the brightness before
constexpr double kUnusualJump = 8;   // median changes of brightness

bool is_usable(const FrameLook& frame) {
  return frame.color.brightness >= kDark && frame.color.brightness <= kBright &&
         frame.color.contrast >= kFlat;
}

/// Change of brightness relative to the frame before; 0 where one of the two is of no use.
std::vector<double> brightness_changes(const std::vector<FrameLook>& frames) {
  std::vector<double> changes(frames.size(), 0.0);
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (is_usable(frames[i]) && is_usable(frames[i - 1]))
      changes[i] = std::abs(frames[i].color.brightness / frames[i - 1].color.brightness - 1);
  return changes;
}

}  // namespace

Finding check_frozen(const std::vector<FrameLook>& frames) {
  return share_of(frames, "frozen", "repeat the colour picture before",
                  [](const auto& f) { return is_usable(f) && f.color_change < kFrozenChange; });
}

Finding check_blur(const std::vector<FrameLook>& frames) {
  std::vector<double> sharpness;
  for (const auto& frame : frames)
    if (is_usable(frame)) sharpness.push_back(frame.color.sharpness);
  const double limit = sharpness.empty() ? 0 : std::max(kSoft, kLessSharp * percentile(sharpness, 50));
  return share_of(frames, "blur", "are blurred",
                  [&](const auto& f) { return is_usable(f) && f.color.sharpness < limit; });
}

Finding check_exposure(const std::vector<FrameLook>& frames) {
  return share_of(frames, "exposure", "are black, white or flat: no light, or a covered lens",
                  [](const auto& f) { return !is_usable(f); });
}

Finding check_exposure_jumps(const std::vector<FrameLook>& frames) {
  const auto changes = brightness_changes(frames);
  const double limit = std::max(kJumpShare, kUnusualJump * percentile(changes, 50));
  return share_of(
      frames, "exposure jumps", "are much brighter or darker than the one before",
      [&](const auto& f) { return changes[static_cast<std::size_t>(&f - frames.data())] > limit; });
}

}  // namespace rds::doctor
