// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

/// Map points on surfaces that a keyframe has measured where it should see them.
struct SeenAgain {
  int expected = 0;
  double log_ratios = 0;  // sum over the expected points

  /// Log-odds that the place is the same one and not one that looks alike; 0 where too few points are
  /// expected, as in a saved map.
  ///
  ///   −log( (1 − τ) · exp(−L) + τ ),  L = 22 · mean of ln( P(seen | same) / P(seen | other) )
  ///
  /// Points beside each other say the same: all together are worth 22. One of so many places that look alike
  /// (τ) does so in every detail.
  [[nodiscard]] double log_odds() const;
  /// A point looks alike in the same place with p(θ) = .88 · exp(−θ / 50°), in another one with .73 p(θ).
  /// @param angle_rad  θ between the directions from which it is and was seen.
  void add(double angle_rad, bool is_alike);
  void operator+=(const SeenAgain& other);
};

/// Looks for points in a keyframe that is thought to be in another place. What is hidden there, or stands
/// elsewhere, is not expected; so a room that has the shape of another one is told from it by what hangs on
/// its walls.
/// @param points  of the place. @param camera_from_map  the keyframe's pose there.
/// Points without a kept picture, as in a saved map, are not expected, and none is in a keyframe without one.
SeenAgain see_again(const SlamMap& map, std::span<const PointId> points, const Keyframe& keyframe,
                    const Pose& camera_from_map);

}  // namespace rds::tracker
