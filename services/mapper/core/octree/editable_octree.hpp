// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <octomap/ColorOcTree.h>

namespace rds::mapper {

/// A ColorOcTree whose nodes can be reached block by block. Never pruned: every leaf is a voxel at the finest
/// level, and an inner node is a pure function of its children (largest log-odds, mean colour). Two trees
/// with equal leaves are equal.
class EditableOcTree : public octomap::ColorOcTree {
 public:
  using Node = octomap::ColorOcTreeNode;
  static constexpr unsigned kDepth = 16;

  explicit EditableOcTree(double resolution_m) : ColorOcTree(resolution_m) {}
  /// A deep copy. ColorOcTree's own copy constructor makes children of the base class's size: their colours
  /// are lost.
  EditableOcTree(const EditableOcTree& other);
  EditableOcTree& operator=(const EditableOcTree&) = delete;

  /// Nodes from the root (path[0]) to the node of `key` at `depth`, created where missing; leaves met on the
  /// way are expanded. The values of created nodes are 0 until their leaves are set and refresh() ran.
  Node* descend(const octomap::OcTreeKey& key, unsigned depth, std::array<Node*, kDepth + 1>& path);

  /// Child, created when missing.
  Node* child(Node* parent, unsigned index) {
    return nodeChildExists(parent, index) ? getNodeChild(parent, index) : createNodeChild(parent, index);
  }

  /// Deletes a child that is a voxel, or an inner node without children.
  void erase_child(Node* parent, unsigned index);

  /// Inner node from its children.
  static void refresh(Node* node) {
    node->updateOccupancyChildren();
    node->updateColorChildren();
  }

  /// Takes over another tree's nodes.
  void adopt(octomap::ColorOcTree&& other) { swapContent(other); }

 private:
  void copy_children(Node* to, const EditableOcTree& other, const Node* from);
};

}  // namespace rds::mapper
