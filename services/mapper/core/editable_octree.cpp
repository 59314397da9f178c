// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/editable_octree.hpp"

namespace rds::mapper {

EditableOcTree::Node* EditableOcTree::descend(const octomap::OcTreeKey& key, unsigned depth,
                                              std::array<Node*, kDepth + 1>& path) {
  bool created = root == nullptr;
  if (created) {
    root = new Node();  // owned by the base class, as every node it makes
    ++tree_size;
    size_changed = true;
  }
  path[0] = root;
  for (unsigned level = 0; level < depth; ++level) {
    Node* node = path[level];
    if (!created && !nodeHasChildren(node)) expandNode(node);
    const unsigned index = octomap::computeChildIdx(key, static_cast<int>(kDepth - 1 - level));
    created = !nodeChildExists(node, index);
    path[level + 1] = child(node, index);
  }
  return path[depth];
}

void EditableOcTree::erase(const octomap::OcTreeKey& key) {
  if (search(key) == nullptr) return;
  deleteNode(key);
  if (root != nullptr && !nodeHasChildren(root)) clear();
}

}  // namespace rds::mapper
