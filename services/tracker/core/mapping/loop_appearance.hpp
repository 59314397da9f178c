// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

/// Map points on surfaces that a keyframe has measured where it should see them.
struct SeenAgain {
  int expected = 0;
  int alike = 0;  // whose surroundings look there as in the keyframes that saw them

  [[nodiscard]] double share() const { return expected > 0 ? static_cast<double>(alike) / expected : 0; }
};

/// Looks for points in a keyframe that is thought to be in another place. What is hidden there, or stands
/// elsewhere, is not expected; so a room that has the shape of another one is told from it by what hangs on
/// its walls.
/// @param points  of the place. @param camera_from_map  the keyframe's pose there.
/// @return nullopt where too few pictures are kept to tell, as in a saved map.
std::optional<SeenAgain> see_again(const SlamMap& map, std::span<const PointId> points,
                                   const Keyframe& keyframe, const Pose& camera_from_map,
                                   const DepthConfig& depth);

}  // namespace rds::tracker
