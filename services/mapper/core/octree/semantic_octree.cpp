// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/semantic_octree.hpp"

#include <algorithm>

#include "services/mapper/core/octree/voxel_walk.hpp"

namespace rds::mapper {
namespace {

constexpr double kLowestProbability = 0.12;  // as the evidence clamps
constexpr double kHighestProbability = 0.97;
constexpr unsigned kBlockDepth = EditableOcTree::kDepth - kBlockBits;
constexpr unsigned kBlockSide = 1U << kBlockBits;

/// Whether one of some cells is in a set. @param count  512, 64, 8 or 1, of which `first` is a multiple.
bool has_any(const BlockMask& mask, unsigned first, unsigned count) {
  if (count == kBlockCells) return !mask.empty();
  if (count == 64) return mask.word(first / 64) != 0;
  return count == 1 ? mask.has(first) : mask.eight(first) != 0;
}

}  // namespace

SemanticOctree::SemanticOctree(const OctreeConfig& config) : config_(config), tree_(config.resolution_m) {
  tree_.setClampingThresMin(kLowestProbability);
  tree_.setClampingThresMax(kHighestProbability);
  tree_.setOccupancyThres(0.5);
}

std::uint16_t SemanticOctree::label(const octomap::OcTreeKey& key) const {
  const auto found = labels_.find(packed(block_key(key)));
  return found == labels_.end() ? std::uint16_t{0} : found->second[cell_of(key)];
}

void SemanticOctree::show(const octomap::OcTreeKey& key, const EvidenceBlock& block, const BlockMask& voxels,
                          const LabelTable& labels, MapDelta& delta) {
  if (block.occupancy().known.empty() && tree_.search(key, kBlockDepth) == nullptr) return;
  std::array<Node*, EditableOcTree::kDepth + 1> path{};
  Node* top = tree_.descend(key, kBlockDepth, path);
  if (!show_children(top, key, 0, kBlockSide / 2, {block, voxels, labels, delta})) return;
  for (unsigned depth = kBlockDepth; depth-- > 0;) {
    Node* parent = path[depth];
    const unsigned index =
        octomap::computeChildIdx(key, static_cast<int>(EditableOcTree::kDepth - 1 - depth));
    if (!tree_.nodeHasChildren(path[depth + 1])) tree_.erase_child(parent, index);
    if (tree_.nodeHasChildren(parent)) EditableOcTree::refresh(parent);
  }
  if (!tree_.nodeHasChildren(path[0])) tree_.clear();
}

/// @param half  of the parent's side [voxels]. @return whether something changed.
bool SemanticOctree::show_children(Node* parent, const octomap::OcTreeKey& key, unsigned first_cell,
                                   unsigned half, const Source& source) {
  const unsigned cells = half * half * half;  // of a child
  bool changed = false;
  for (unsigned index = 0; index < 8; ++index) {
    const unsigned first = first_cell + index * cells;
    if (!has_any(source.voxels, first, cells)) continue;
    const octomap::OcTreeKey its_key = child_key(key, index, half);
    if (half == 1) {
      changed |= show_voxel(parent, index, its_key, first, source);
      continue;
    }
    if (!tree_.nodeChildExists(parent, index) && !has_any(source.block.occupancy().known, first, cells))
      continue;
    Node* node = tree_.child(parent, index);
    changed |= show_children(node, its_key, first, half / 2, source);
    if (!tree_.nodeHasChildren(node)) tree_.erase_child(parent, index);
  }
  if (changed && tree_.nodeHasChildren(parent)) EditableOcTree::refresh(parent);
  return changed;
}

bool SemanticOctree::show_voxel(Node* parent, unsigned index, const octomap::OcTreeKey& key, unsigned cell,
                                const Source& source) {
  const bool is_there = tree_.nodeChildExists(parent, index);
  if (!source.block.occupancy().known.has(cell)) {
    if (is_there) erase_voxel(parent, index, key, source);
    return is_there;
  }
  Node* node = tree_.child(parent, index);
  const bool was_occupied = is_there && tree_.isNodeOccupied(node);
  const std::uint16_t label_before = was_occupied ? label(key) : std::uint16_t{0};
  const Voxel voxel = voxel_of(cell, source);
  const bool is_same = node->getLogOdds() == voxel.value && node->getColor() == voxel.color;
  if (is_there && is_same && label_before == voxel.label) return false;
  node->setLogOdds(voxel.value);
  node->setColor(voxel.color);
  if (voxel.label != label_before) set_label(key, voxel.label);
  if (!is_there) bounds_.add(key);
  if (was_occupied) --occupied_;
  if (tree_.isNodeOccupied(node)) ++occupied_;
  source.delta.add(key, *node, voxel.label);
  return true;
}

void SemanticOctree::erase_voxel(Node* parent, unsigned index, const octomap::OcTreeKey& key,
                                 const Source& source) {
  if (tree_.isNodeOccupied(tree_.getNodeChild(parent, index))) --occupied_;
  bounds_.remove(key);
  tree_.deleteNodeChild(parent, index);
  set_label(key, 0);
  source.delta.deleted_keys.insert(source.delta.deleted_keys.end(), {key[0], key[1], key[2]});
}

/// As the evidence has it; a free one has neither colour nor label.
SemanticOctree::Voxel SemanticOctree::voxel_of(unsigned cell, const Source& source) const {
  const LogOdds log_odds = source.block.occupancy().values[cell];
  Voxel voxel{in_nats(log_odds), {}, 0};
  const VoxelLook* look = log_odds > 0 ? source.block.look(static_cast<std::uint16_t>(cell)) : nullptr;
  if (look == nullptr) return voxel;
  voxel.label = look->label();
  const bool is_told = voxel.label != 0 && config_.color_by_label;
  const Rgb rgb = is_told ? source.labels.color(voxel.label) : look->color();
  voxel.color = {rgb[0], rgb[1], rgb[2]};
  return voxel;
}

void SemanticOctree::set_label(const octomap::OcTreeKey& key, std::uint16_t label) {
  const std::uint64_t block = packed(block_key(key));
  if (label != 0 || labels_.contains(block)) labels_[block][cell_of(key)] = label;
}

}  // namespace rds::mapper
