// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

/// Computes a keyframe's edges of the covisibility graph from its points, at both ends: to keyframes that
/// share at least 15 points, and to the one that shares most. Source: Mur-Artal et al. 2015, §III-D.
void update_covisibility(SlamMap& map, KeyframeId keyframe);
void update_all_covisibility(SlamMap& map);

/// Removes a keyframe's edges at their other ends.
void remove_covisibility(SlamMap& map, const Keyframe& keyframe);

}  // namespace rds::tracker
