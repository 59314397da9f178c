// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/editable_octree.hpp"

namespace rds::mapper {

EditableOcTree::EditableOcTree(const EditableOcTree& other) : ColorOcTree(other.getResolution()) {
  setClampingThresMin(other.getClampingThresMin());
  setClampingThresMax(other.getClampingThresMax());
  setOccupancyThres(other.getOccupancyThres());
  if (other.root == nullptr) return;
  std::array<Node*, kDepth + 1> path{};
  copy_children(descend({0, 0, 0}, 0, path), other, other.root);
}

void EditableOcTree::copy_children(Node* to, const EditableOcTree& other, const Node* from) {
  to->copyData(*from);
  for (unsigned i = 0; i < 8; ++i)
    if (other.nodeChildExists(from, i))
      copy_children(createNodeChild(to, i), other, other.getNodeChild(from, i));
}

/// OctoMap deletes no node that has once had children, unless they were pruned.
void EditableOcTree::erase_child(Node* parent, unsigned index) {
  Node* node = getNodeChild(parent, index);
  expandNode(node);
  pruneNode(node);
  deleteNodeChild(parent, index);
}

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

}  // namespace rds::mapper
