// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/ColorOcTree.h>

namespace rds::mapper {

/// Key of a node's child. @param half  of the node's side [voxels].
inline octomap::OcTreeKey child_key(const octomap::OcTreeKey& key, unsigned index, unsigned half) {
  const auto at = [&](unsigned axis) {
    return static_cast<std::uint16_t>(key[axis] + ((index >> axis & 1) != 0 ? half : 0));
  };
  return {at(0), at(1), at(2)};
}

/// Calls visit(key, node) for every voxel at the finest level, in the order in which to_bytes() writes them;
/// a pruned leaf is visited once for each voxel it stands for. Several times faster than OctoMap's iterators.
template <class Visit>
class VoxelWalk {
 public:
  VoxelWalk(const octomap::ColorOcTree& tree, const Visit& visit) : tree_(tree), visit_(visit) {
    if (tree.getRoot() != nullptr) go(*tree.getRoot(), {0, 0, 0}, 1U << (tree.getTreeDepth() - 1));
  }

 private:
  /// @param half  of the node's side [voxels]; 0 at the finest level.
  void go(const octomap::ColorOcTreeNode& node, const octomap::OcTreeKey& key, unsigned half) {
    if (half == 0) return visit_(key, node);
    const bool is_pruned = !tree_.nodeHasChildren(&node);
    for (unsigned i = 0; i < 8; ++i) {
      if (!is_pruned && !tree_.nodeChildExists(&node, i)) continue;
      go(is_pruned ? node : *tree_.getNodeChild(&node, i), child_key(key, i, half), half / 2);
    }
  }

  const octomap::ColorOcTree& tree_;
  const Visit& visit_;
};

template <class Visit>
void for_each_voxel(const octomap::ColorOcTree& tree, const Visit& visit) {
  VoxelWalk<Visit>(tree, visit);
}

}  // namespace rds::mapper
