// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/semantic_octree.hpp"
#include "services/mapper/core/octree/voxel_walk.hpp"

namespace rds::mapper {
namespace {

using Node = octomap::ColorOcTreeNode;
using octomap::OcTreeKey;

/// Walks two unpruned trees side by side.
class TreeComparison {
 public:
  TreeComparison(const SemanticOctree& older, const SemanticOctree& newer, MapDelta& delta)
      : older_(older), newer_(newer), delta_(delta) {}

  void walk(const Node* was, const Node* is, unsigned depth, const OcTreeKey& key) {
    if (was == nullptr && is == nullptr) return;
    if (depth == EditableOcTree::kDepth) {
      compare(was, is, key);
      return;
    }
    const unsigned size = 1U << (EditableOcTree::kDepth - 1 - depth);
    for (unsigned i = 0; i < 8; ++i) {
      walk(child_of(older_.tree(), was, i), child_of(newer_.tree(), is, i), depth + 1,
           child_key(key, i, size));
    }
  }

 private:
  static const Node* child_of(const octomap::ColorOcTree& tree, const Node* node, unsigned index) {
    return node != nullptr && tree.nodeChildExists(node, index) ? tree.getNodeChild(node, index) : nullptr;
  }

  void compare(const Node* was, const Node* is, const OcTreeKey& key) {
    if (is == nullptr) {
      delta_.deleted_keys.insert(delta_.deleted_keys.end(), {key[0], key[1], key[2]});
      return;
    }
    const auto label = newer_.label(key);
    if (was != nullptr && *was == *is && older_.label(key) == label) return;
    delta_.add(key, *is, label);
  }

  const SemanticOctree& older_;
  const SemanticOctree& newer_;
  MapDelta& delta_;
};

}  // namespace

void SemanticOctree::difference(const SemanticOctree& newer, MapDelta& delta) const {
  TreeComparison(*this, newer, delta).walk(tree_.getRoot(), newer.tree_.getRoot(), 0, OcTreeKey(0, 0, 0));
}

}  // namespace rds::mapper
