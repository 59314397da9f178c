// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace rds::evaluation {

/// Voxel indices in one 64-bit number, 21 bits an axis; ascending in x, then y, then z.
using VoxelKey = std::int64_t;

VoxelKey pack(const Eigen::Vector3i& index);
Eigen::Vector3i unpack(VoxelKey key);
/// The voxel that holds a point [m].
VoxelKey voxel_of(const Eigen::Vector3d& point, double resolution_m);

/// Ascending without repetition.
using VoxelSet = std::vector<VoxelKey>;

/// Sorts and drops repetitions.
VoxelSet make_voxel_set(std::vector<VoxelKey> keys);
/// True if a voxel of the set lies within `radius` voxels (a cube of side 2·radius + 1) around `key`.
bool has_neighbour(const VoxelSet& set, VoxelKey key, int radius);

/// A voxel and the number of sets it is in.
struct CountedVoxel {
  VoxelKey key;
  std::size_t count;
};
/// Counts over many sets; ascending by key.
std::vector<CountedVoxel> count_voxels(const std::vector<VoxelSet>& sets);

}  // namespace rds::evaluation
