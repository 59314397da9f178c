// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/tracker/core/map/slam_map.hpp"
#include "services/tracker/core/mapping/local_mapping.hpp"

namespace rds::tracker {

/// Snapshot around a keyframe: it and its best covisible keyframes, which may move, their points, and further
/// keyframes that see these points, which hold them. The very first keyframe and fixed ones never move.
LocalMappingJob make_mapping_job(const SlamMap& map, KeyframeId keyframe);

/// Brings a result into the map as it is now. Keyframes made since the snapshot, and their points, move
/// rigidly with the keyframe at the snapshot's centre.
void apply_mapping_result(SlamMap& map, const LocalMappingResult& result);

/// Sets corrected keyframe poses. A keyframe that is not among them moves as the nearest older corrected one
/// does (the oldest corrected one if there is none); a point moves with the keyframe that made it. Keyframes
/// that are fixed and their points stay. Unknown ids and poses that are not finite are ignored.
void apply_correction(SlamMap& map, std::span<const KeyframePose> corrected);

}  // namespace rds::tracker
