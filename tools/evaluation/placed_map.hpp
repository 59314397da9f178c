// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/evaluation/octree_file.hpp"
#include "tools/evaluation/trajectory_evaluation.hpp"

namespace rds::evaluation {

/// The map of a run, and how it lies in the truth.
struct PlacedMap {
  OctreeFile tree;
  geometry::Pose truth_from_map;
};

/// Reads map.ot, and lays the run's keyframes.txt on the recording's groundtruth.txt.
/// @return or one sentence that names what cannot be read, or does not fit.
tl::expected<PlacedMap, std::string> read_placed_map(const std::filesystem::path& recording,
                                                     const std::filesystem::path& out, Alignment align);

/// Centres [m] of the voxels that hold a surface of a rendered floor: its truth.ot.
/// @return or one sentence: it cannot be read, or has voxels of another size.
tl::expected<std::vector<Eigen::Vector3d>, std::string> read_surfaces(const std::filesystem::path& recording,
                                                                      double voxel_m);

}  // namespace rds::evaluation
