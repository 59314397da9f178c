// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

inline constexpr double kTruthVoxelM = 0.05;

/// Points on all triangles of a mesh, corners included, no more than half a voxel apart [m].
std::vector<Eigen::Vector3f> surface_points(const Mesh& mesh);

/// Writes the voxels that hold a surface of the scene, as an OctoMap tree (.ot) of occupied leaves. What no
/// camera can see (the back of a shelf) is in it, too.
///
/// @throws std::runtime_error naming the file that could not be written.
void write_truth_map(const Scene& scene, const std::filesystem::path& file);

}  // namespace rds::simulator
