// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

/// The part of the map that a frame should see.
struct LocalMap {
  std::vector<KeyframeId> keyframes;
  std::vector<PointId> points;   // not yet seen by the frame
  KeyframeId reference = kNoId;  // the keyframe that shares most points with the frame
};

/// Keyframes that see a frame's map points, their best covisible ones, and the points of all these.
///
/// @param seen  map points of the frame; kNoId and unknown ones count for nothing.
/// @param mark  a number never used before; marks points in the map.
/// Source: Mur-Artal et al. 2015, §V-D.
LocalMap select_local_map(SlamMap& map, std::span<const PointId> seen, std::uint64_t mark);

/// Those of the points, in the camera frame, that many keyframes and frames have found in their place.
std::vector<Eigen::Vector3f> stable_points(const SlamMap& map, std::span<const PointId> points,
                                           const Pose& camera_from_map);

}  // namespace rds::tracker
