// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "services/tracker/core/submaps/submap_joining.hpp"

namespace rds::tracker {

/// Looks for the place that a keyframe of a submap shows in older submaps, as far around the place where the
/// camera was lost as it can have walked (LoopDrift::reach_m()): by votes of all the keyframe's features
/// (vote_for_poses()), which tell the place where too few of them match for certain.
/// @return the keyframe that sees most of what is met; nullopt if the keyframe meets fewer than 50 points
/// that look like its features, or these lie in one plane, or the submaps do not fit (fits()).
std::optional<FoundKeyframe> find_around_loss(const SlamMap& map, KeyframeId keyframe);

}  // namespace rds::tracker
