// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/tree_bytes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "services/mapper/core/keyframe/voxel_key.hpp"
#include "services/mapper/core/octree/editable_octree.hpp"

namespace rds::mapper {
namespace {

using Node = octomap::ColorOcTreeNode;
constexpr const char* kTooManyVoxels = "leaves larger than any map";
constexpr std::size_t kNodeBytes = 8;  // float log-odds, r, g, b, children

void append(const octomap::ColorOcTree& tree, const Node& node, std::vector<std::uint8_t>& bytes) {
  const auto value = std::bit_cast<std::array<std::uint8_t, 4>>(node.getLogOdds());
  bytes.insert(bytes.end(), value.begin(), value.end());
  const auto color = node.getColor();
  std::uint8_t children = 0;
  for (unsigned i = 0; i < 8; ++i)
    if (tree.nodeChildExists(&node, i)) children = static_cast<std::uint8_t>(children | 1U << i);
  bytes.insert(bytes.end(), {color.r, color.g, color.b, children});
  for (unsigned i = 0; i < 8; ++i)
    if ((children >> i & 1) != 0) append(tree, *tree.getNodeChild(&node, i), bytes);
}

/// Counts the voxels that a reader makes against what its input may ask for.
class VoxelBudget {
 public:
  VoxelBudget(std::size_t bytes, std::uint64_t voxels_per_byte)
      : left_(std::min(kMaxVoxels, kFreeVoxels + voxels_per_byte * bytes)) {}

  /// A leaf stands for all voxels below it, and what lies in a block of the evidence makes all of the block.
  /// @return false if these are too many.
  bool take(unsigned depth, bool is_leaf) {
    constexpr unsigned kBlockDepth = EditableOcTree::kDepth - kBlockBits;
    if (depth > kBlockDepth || (depth < kBlockDepth && !is_leaf)) return true;
    const std::uint64_t voxels = std::uint64_t{1} << 3 * (EditableOcTree::kDepth - depth);
    if (voxels > left_) return false;
    left_ -= voxels;
    return true;
  }

 private:
  std::uint64_t left_;
};

/// Gives a leaf the voxels that it stands for.
void expand(EditableOcTree& tree, Node* leaf, unsigned depth) {
  if (depth == EditableOcTree::kDepth) return;
  tree.expandNode(leaf);
  for (unsigned i = 0; i < 8; ++i) expand(tree, tree.getNodeChild(leaf, i), depth + 1);
}

/// What two bits say of a child.
enum Child : unsigned { kUnknown = 0, kFree = 1, kOccupied = 2, kInner = 3 };

/// Reads nodes in the order in which writeData() and writeBinaryData() write them. The depth is bounded, so
/// recursion is.
class TreeReader {
 public:
  TreeReader(std::span<const std::uint8_t> bytes, EditableOcTree& tree, bool is_binary)
      : bytes_(bytes),
        tree_(tree),
        budget_(bytes.size(), is_binary ? kVoxelsPerBinaryByte : kVoxelsPerByte) {}

  /// Fault in one sentence; empty if all bytes were read.
  std::string read(bool is_binary) {
    std::array<Node*, EditableOcTree::kDepth + 1> path{};
    Node* root = tree_.descend({0, 0, 0}, 0, path);
    if (auto fault = is_binary ? children_of(root, 0) : node(root, 0); !fault.empty()) return fault;
    if (is_binary && !tree_.nodeHasChildren(root)) tree_.clear();
    return at_ == bytes_.size() ? "" : fmt::format("{} bytes after the last node", bytes_.size() - at_);
  }

 private:
  std::string node(Node* node, unsigned depth) {
    if (bytes_.size() - at_ < kNodeBytes)
      return fmt::format("the tree ends after {} bytes in the middle of a node", bytes_.size());
    float value = 0;
    std::memcpy(&value, &bytes_[at_], 4);
    const std::uint8_t children = bytes_[at_ + 7];
    if (!std::isfinite(value)) return fmt::format("the log-odds at byte {} are not finite", at_);
    node->setLogOdds(value);
    node->setColor(bytes_[at_ + 4], bytes_[at_ + 5], bytes_[at_ + 6]);
    at_ += kNodeBytes;
    if (!budget_.take(depth, children == 0)) return kTooManyVoxels;
    if (children == 0) {
      expand(tree_, node, depth);
      return {};
    }
    if (depth == EditableOcTree::kDepth) return "a node below the finest level";
    for (unsigned i = 0; i < 8; ++i)
      if ((children >> i & 1) != 0)
        if (auto fault = this->node(tree_.child(node, i), depth + 1); !fault.empty()) return fault;
    EditableOcTree::refresh(node);
    return {};
  }

  std::string children_of(Node* node, unsigned depth) {
    if (depth == EditableOcTree::kDepth) return "a node below the finest level";
    if (bytes_.size() - at_ < 2)
      return fmt::format("the tree ends after {} bytes in the middle of a node", bytes_.size());
    const unsigned bits = bytes_[at_] | static_cast<unsigned>(bytes_[at_ + 1]) << 8;
    at_ += 2;
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned state = bits >> 2 * i & 3;
      if (state == kUnknown) continue;
      if (!budget_.take(depth + 1, state != kInner)) return kTooManyVoxels;
      Node* child = tree_.child(node, i);
      if (state == kInner) {
        if (auto fault = children_of(child, depth + 1); !fault.empty()) return fault;
        continue;
      }
      child->setLogOdds(state == kOccupied ? kBinaryLogOdds : -kBinaryLogOdds);
      expand(tree_, child, depth + 1);
    }
    if (!tree_.nodeHasChildren(node)) return depth == 0 ? "" : "an inner node without children";
    EditableOcTree::refresh(node);
    return {};
  }

  std::span<const std::uint8_t> bytes_;
  EditableOcTree& tree_;
  std::size_t at_ = 0;
  VoxelBudget budget_;
};

class BinaryWriter {
 public:
  BinaryWriter(const octomap::ColorOcTree& tree, std::vector<std::uint8_t>& bytes)
      : tree_(tree), bytes_(bytes) {}

  /// Writes a node and all below it; nothing if one state says the same, unless it is the root.
  Child write(const Node& node, bool is_root) {
    const std::size_t at = bytes_.size();
    bytes_.insert(bytes_.end(), {0, 0});
    std::array<unsigned, 8> children{};
    for (unsigned i = 0; i < 8; ++i) {
      children[i] = child_of(node, i);
      auto& byte = bytes_[at + i / 4];
      byte = static_cast<std::uint8_t>(byte | children[i] << 2 * (i % 4));
    }
    const bool is_one = std::ranges::all_of(children, [&](unsigned c) { return c == children[0]; });
    if (is_root || !is_one || children[0] == kInner) return kInner;
    bytes_.resize(at);
    return static_cast<Child>(children[0]);
  }

 private:
  Child child_of(const Node& node, unsigned index) {
    const bool is_pruned = !tree_.nodeHasChildren(&node);
    if (!is_pruned && !tree_.nodeChildExists(&node, index)) return kUnknown;
    const Node& child = is_pruned ? node : *tree_.getNodeChild(&node, index);
    if (!is_pruned && tree_.nodeHasChildren(&child)) return write(child, false);
    return tree_.isNodeOccupied(child) ? kOccupied : kFree;
  }

  const octomap::ColorOcTree& tree_;
  std::vector<std::uint8_t>& bytes_;
};

}  // namespace

std::vector<std::uint8_t> to_binary_bytes(const octomap::ColorOcTree& tree) {
  std::vector<std::uint8_t> bytes;
  if (tree.getRoot() != nullptr) BinaryWriter(tree, bytes).write(*tree.getRoot(), true);
  return bytes;
}

std::vector<std::uint8_t> to_bytes(const octomap::ColorOcTree& tree) {
  std::vector<std::uint8_t> bytes;
  if (tree.getRoot() == nullptr) return bytes;
  bytes.reserve(tree.size() * kNodeBytes);
  append(tree, *tree.getRoot(), bytes);
  return bytes;
}

namespace {

tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> read_tree_bytes(
    std::span<const std::uint8_t> bytes, double resolution_m, bool is_binary) {
  if (!(resolution_m > 1e-4 && resolution_m < 1e3))
    return tl::unexpected(fmt::format("a resolution of {} m is not possible", resolution_m));
  auto tree = std::make_unique<EditableOcTree>(resolution_m);
  if (bytes.empty()) return tree;
  if (auto fault = TreeReader(bytes, *tree, is_binary).read(is_binary); !fault.empty())
    return tl::unexpected(std::move(fault));
  return tree;
}

}  // namespace

tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> tree_from_bytes(
    std::span<const std::uint8_t> bytes, double resolution_m) {
  return read_tree_bytes(bytes, resolution_m, false);
}

tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> tree_from_binary_bytes(
    std::span<const std::uint8_t> bytes, double resolution_m) {
  return read_tree_bytes(bytes, resolution_m, true);
}

}  // namespace rds::mapper
