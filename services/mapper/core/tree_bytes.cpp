// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/tree_bytes.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "services/mapper/core/editable_octree.hpp"

namespace rds::mapper {
namespace {

using Node = octomap::ColorOcTreeNode;
constexpr std::size_t kNodeBytes = 8;  // float log-odds, r, g, b, children
constexpr std::uint64_t kMaxVoxels = 100'000'000;

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

/// Reads nodes in the order in which writeData writes them. The depth is bounded, so recursion is.
class Reader {
 public:
  Reader(std::span<const std::uint8_t> bytes, EditableOcTree& tree) : bytes_(bytes), tree_(tree) {}

  /// Fault in one sentence; empty if all bytes were read.
  std::string read() {
    std::array<Node*, EditableOcTree::kDepth + 1> path{};
    if (!node(tree_.descend({0, 0, 0}, 0, path), 0)) return fault_;
    if (at_ != bytes_.size()) return fmt::format("{} bytes after the last node", bytes_.size() - at_);
    return {};
  }

 private:
  bool node(Node* node, unsigned depth) {
    if (bytes_.size() - at_ < kNodeBytes)
      return fail(fmt::format("the tree ends after {} bytes in the middle of a node", bytes_.size()));
    float value = 0;
    std::memcpy(&value, &bytes_[at_], 4);
    const std::uint8_t children = bytes_[at_ + 7];
    if (!std::isfinite(value)) return fail(fmt::format("the log-odds at byte {} are not finite", at_));
    node->setLogOdds(value);
    node->setColor(bytes_[at_ + 4], bytes_[at_ + 5], bytes_[at_ + 6]);
    at_ += kNodeBytes;
    if (children == 0) return expand(node, depth);
    if (depth == EditableOcTree::kDepth) return fail("a node below the finest level");
    for (unsigned i = 0; i < 8; ++i)
      if ((children >> i & 1) != 0 && !this->node(tree_.child(node, i), depth + 1)) return false;
    EditableOcTree::refresh(node);
    return true;
  }

  /// A pruned leaf stands for all voxels below it.
  bool expand(Node* node, unsigned depth) {
    if (depth == EditableOcTree::kDepth) return ++voxels_ <= kMaxVoxels || fail("too many voxels");
    const std::uint64_t voxels = std::uint64_t{1} << 3 * (EditableOcTree::kDepth - depth);
    if (voxels > kMaxVoxels - voxels_) return fail("a leaf larger than any map");
    tree_.expandNode(node);
    for (unsigned i = 0; i < 8; ++i)
      if (!expand(tree_.getNodeChild(node, i), depth + 1)) return false;
    return true;
  }

  bool fail(std::string fault) {
    fault_ = std::move(fault);
    return false;
  }

  std::span<const std::uint8_t> bytes_;
  EditableOcTree& tree_;
  std::size_t at_ = 0;
  std::uint64_t voxels_ = 0;
  std::string fault_;
};

}  // namespace

std::vector<std::uint8_t> to_bytes(const octomap::ColorOcTree& tree) {
  std::vector<std::uint8_t> bytes;
  if (tree.getRoot() == nullptr) return bytes;
  bytes.reserve(tree.size() * kNodeBytes);
  append(tree, *tree.getRoot(), bytes);
  return bytes;
}

tl::expected<std::unique_ptr<octomap::ColorOcTree>, std::string> tree_from_bytes(
    std::span<const std::uint8_t> bytes, double resolution_m) {
  if (!(resolution_m > 1e-4 && resolution_m < 1e3))
    return tl::unexpected(fmt::format("a resolution of {} m is not possible", resolution_m));
  auto tree = std::make_unique<EditableOcTree>(resolution_m);
  if (bytes.empty()) return tree;
  if (auto fault = Reader(bytes, *tree).read(); !fault.empty()) return tl::unexpected(std::move(fault));
  return tree;
}

}  // namespace rds::mapper
