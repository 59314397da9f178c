// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/voxels/voxel_set.hpp"

#include <algorithm>
#include <cmath>

namespace rds::evaluation {
namespace {
constexpr int kBits = 21;
constexpr VoxelKey kOffset = VoxelKey{1} << (kBits - 1);
constexpr VoxelKey kMask = (VoxelKey{1} << kBits) - 1;
}  // namespace

VoxelKey pack(const Eigen::Vector3i& index) {
  return (index.x() + kOffset) << (2 * kBits) | (index.y() + kOffset) << kBits | (index.z() + kOffset);
}

Eigen::Vector3i unpack(VoxelKey key) {
  return {static_cast<int>((key >> (2 * kBits)) - kOffset),
          static_cast<int>((key >> kBits & kMask) - kOffset), static_cast<int>((key & kMask) - kOffset)};
}

VoxelKey voxel_of(const Eigen::Vector3d& point, double resolution_m) {
  // The range of an index: a point further away (nonsense poses) goes to the border voxel.
  const auto limit = static_cast<double>(kOffset - 4);
  const Eigen::Array3d index = (point.array() / resolution_m).floor().max(-limit).min(limit);
  return pack(index.matrix().cast<int>());
}

VoxelSet make_voxel_set(std::vector<VoxelKey> keys) {
  std::ranges::sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

bool has_neighbour(const VoxelSet& set, VoxelKey key, int radius) {
  const Eigen::Vector3i center = unpack(key);
  for (int dx = -radius; dx <= radius; ++dx)
    for (int dy = -radius; dy <= radius; ++dy) {
      // Voxels of one column in z follow each other.
      const VoxelKey lowest = pack(center + Eigen::Vector3i(dx, dy, -radius));
      const auto found = std::ranges::lower_bound(set, lowest);
      if (found != set.end() && *found <= lowest + 2 * radius) return true;
    }
  return false;
}

std::vector<CountedVoxel> count_voxels(const std::vector<VoxelSet>& sets) {
  std::size_t total = 0;
  for (const auto& set : sets) total += set.size();
  std::vector<VoxelKey> all;
  all.reserve(total);
  for (const auto& set : sets) all.insert(all.end(), set.begin(), set.end());
  std::ranges::sort(all);
  std::vector<CountedVoxel> counted;
  for (const VoxelKey key : all) {
    if (counted.empty() || counted.back().key != key) counted.push_back({key, 0});
    ++counted.back().count;
  }
  return counted;
}

}  // namespace rds::evaluation
