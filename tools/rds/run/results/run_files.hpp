// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "common/geometry/trajectory.hpp"
#include "tools/rds/run/results/recording.hpp"

namespace rds::run {

/// map_from_camera of every frame with a pose, as estimated live.
std::vector<geometry::StampedPose> live_trajectory(const Recording& recording);

/// The same frames, each through its reference keyframe's final pose; without those whose reference is
/// unknown.
std::vector<geometry::StampedPose> optimized_trajectory(const Recording& recording);

/// The same poses in the frame of the first camera of their map, as evaluation tools expect.
std::vector<geometry::StampedPose> in_first_camera(std::vector<geometry::StampedPose> poses,
                                                   const Recording& recording);

/// Writes trajectory.txt, trajectory_optimized.txt, keyframes.txt, frames.csv, detections.jsonl,
/// loops.jsonl and predictions.jsonl (architecture: "The command line is a contract").
/// @param trajectories_in_map  else they are in_first_camera().
/// @throws std::runtime_error naming the file that cannot be written.
void write_run_files(const Recording& recording, const std::filesystem::path& folder,
                     bool trajectories_in_map);

}  // namespace rds::run
