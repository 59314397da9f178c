// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/visits/moved_pieces.hpp"

#include <algorithm>
#include <iterator>

namespace rds::evaluation {
namespace {

/// Index of a voxel in a set; its size if it is not in it.
std::size_t find(const VoxelSet& voxels, VoxelKey key) {
  const auto at = std::ranges::lower_bound(voxels, key);
  const bool is_there = at != voxels.end() && *at == key;
  return is_there ? static_cast<std::size_t>(at - voxels.begin()) : voxels.size();
}

template <class Visit>
void for_each_neighbour(VoxelKey key, Visit visit) {
  const Eigen::Vector3i center = unpack(key);
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) visit(pack(center + Eigen::Vector3i(x, y, z)));
}

}  // namespace

VoxelSet away_from(const VoxelSet& others, const VoxelSet& all, int radius) {
  VoxelSet away;
  std::ranges::copy_if(all, std::back_inserter(away),
                       [&](VoxelKey key) { return !has_neighbour(others, key, radius); });
  return away;
}

std::vector<std::vector<std::size_t>> connected_parts(const VoxelSet& voxels, std::size_t smallest) {
  std::vector<std::vector<std::size_t>> parts;
  std::vector<bool> is_taken(voxels.size());
  for (std::size_t first = 0; first < voxels.size(); ++first) {
    if (is_taken[first]) continue;
    is_taken[first] = true;
    std::vector<std::size_t> part{first};
    for (std::size_t next = 0; next < part.size(); ++next)
      for_each_neighbour(voxels[part[next]], [&](VoxelKey key) {
        const std::size_t i = find(voxels, key);
        if (i == voxels.size() || is_taken[i]) return;
        is_taken[i] = true;
        part.push_back(i);
      });
    std::ranges::sort(part);
    if (part.size() >= smallest) parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace rds::evaluation
