// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>

#include "services/tracker/core/map/slam_map.hpp"
#include "services/tracker/core/mapping/local_mapping.hpp"

namespace rds::tracker {

/// Snapshot of the whole map, for run_global_adjustment(): all keyframes that may move, their points, and the
/// fixed keyframes that see these, which hold them. The very first keyframe, and where there is none the
/// oldest one, is the gauge.
LocalMappingJob make_global_job(const SlamMap& map);

/// Adjusts all keyframes and points of a map at once: what a closed loop leaves inconsistent goes to where it
/// belongs. The map as it stands is the start of the iterations.
///
/// Pure, single-threaded, deterministic: a fixed number of iterations, never a time limit.
/// @return nullopt if it was stopped.
/// Source: Mur-Artal & Tardós 2017, §III-D (full bundle adjustment).
std::optional<LocalMappingResult> run_global_adjustment(const LocalMappingJob& job,
                                                        const std::stop_token& stop = {});

/// Brings a result into the map as it is now. A keyframe made since the snapshot moves with the one of the
/// snapshot that it shares most points with, a point made since with the keyframe that made it.
void apply_global_adjustment(SlamMap& map, const LocalMappingResult& result);

}  // namespace rds::tracker
