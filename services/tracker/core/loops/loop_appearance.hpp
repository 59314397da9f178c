// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

/// Map points on surfaces that a keyframe has measured where it should see them.
struct SeenAgain {
  int expected = 0;
  int alike = 0;  // whose surroundings look there as in the keyframes that saw them

  [[nodiscard]] double share() const { return expected > 0 ? static_cast<double>(alike) / expected : 0; }
  /// Log-odds that the place is the same one and not one that looks alike; 0 where too few points are
  /// expected, as in a saved map.
  ///
  ///   −log( (1 − τ) · exp(−(s − .72) / .04) + τ ),  s = share()
  ///
  /// One of so many rooms that look alike (τ) does so in every detail.
  [[nodiscard]] double log_odds() const;
  void operator+=(const SeenAgain& other) {
    expected += other.expected;
    alike += other.alike;
  }
};

/// Looks for points in a keyframe that is thought to be in another place. What is hidden there, or stands
/// elsewhere, is not expected; so a room that has the shape of another one is told from it by what hangs on
/// its walls.
/// @param points  of the place. @param camera_from_map  the keyframe's pose there.
/// Points without a kept picture, as in a saved map, are not expected, and none is in a keyframe without one.
SeenAgain see_again(const SlamMap& map, std::span<const PointId> points, const Keyframe& keyframe,
                    const Pose& camera_from_map);

}  // namespace rds::tracker
