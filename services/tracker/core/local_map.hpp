// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "services/tracker/core/association.hpp"

namespace rds::tracker {

/// The part of the map that a frame should see.
struct LocalMap {
  std::vector<KeyframeId> keyframes;
  std::vector<PointId> points;   // not yet seen by the frame
  KeyframeId reference = kNoId;  // the keyframe that shares most points with the frame
};

/// Keyframes that see the frame's map points, their best covisible ones, and the points of all these.
///
/// @param mark  a number never used before; marks points in the map.
/// Source: Mur-Artal et al. 2015, §V-D.
LocalMap select_local_map(SlamMap& map, const TrackedFrame& frame, const MapConfig& config,
                          std::uint64_t mark);

}  // namespace rds::tracker
