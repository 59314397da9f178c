// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/semantic_octree.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "services/mapper/core/keyframe/voxel_projector.hpp"
#include "services/mapper/core/octree/voxel_walk.hpp"

namespace rds::mapper {
namespace {

using Node = EditableOcTree::Node;
// Log-odds per keyframe, paper §IV-C.
constexpr double kHit = 0.85;
constexpr double kMiss = -0.41;
constexpr double kGhostMiss = -1.2;  // a voxel at the upper clamp is free after three rays
constexpr double kLowest = 0.12;     // clamped to these probabilities, as OctoMap does
constexpr double kHighest = 0.97;
constexpr double kLabelShare = 0.25;  // of a voxel's votes: a detector misses an object in many views
constexpr unsigned kBlockDepth = EditableOcTree::kDepth - ScanGrid::kBlockBits;

constexpr unsigned kMeasured = kSurface | kFreeSpace;

/// True if any of the cells has one of `wanted`; `count` is a multiple of 8.
bool any_has(unsigned wanted, const std::uint8_t* flags, std::size_t count) {
  constexpr std::uint64_t kEight = 0x0101010101010101U;
  std::uint64_t any = 0;
  for (std::size_t i = 0; i < count; i += 8) {
    std::uint64_t siblings = 0;
    std::memcpy(&siblings, flags + i, 8);
    any |= siblings;
  }
  return (any & wanted * kEight) != 0;
}

}  // namespace

SemanticOctree::SemanticOctree(const OctreeConfig& config)
    : config_(config),
      lowest_(octomap::logodds(kLowest)),
      highest_(octomap::logodds(kHighest)),
      tree_(config.resolution_m) {
  tree_.setClampingThresMin(kLowest);
  tree_.setClampingThresMax(kHighest);
  tree_.setOccupancyThres(0.5);
}

std::uint16_t SemanticOctree::label(const octomap::OcTreeKey& key) const {
  const auto found = voxels_.find(packed(key));
  return found == voxels_.end() ? std::uint16_t{0} : found->second.label(kLabelShare);
}

void SemanticOctree::integrate(const Update& update) {
  for (const auto& block : update.scan.grid.blocks()) update_block(block, update);
}

/// Voxels that a surface or a ray of a measured pixel meets are made where they are missing; no-return rays
/// change existing voxels only.
void SemanticOctree::update_block(const ScanGrid::Block& block, const Update& update) {
  const octomap::OcTreeKey base(block.key[0], block.key[1], block.key[2]);
  const auto is_concerned = [&](unsigned first, std::size_t count, bool exists) {
    return any_has(exists ? kMeasured | kNoReturnRay : kMeasured, &block.flags[first], count);
  };
  if (!is_concerned(0, block.flags.size(), tree_.search(base, kBlockDepth) != nullptr)) return;
  std::array<Node*, EditableOcTree::kDepth + 1> path{};
  Node* top = tree_.descend(base, kBlockDepth, path);
  for (unsigned outer = 0; outer < 8; ++outer) {
    if (!is_concerned(outer * 64, 64, tree_.nodeChildExists(top, outer))) continue;
    Node* parent = tree_.child(top, outer);
    for (unsigned inner = 0; inner < 8; ++inner) {
      const unsigned first_cell = outer * 64 + inner * 8;
      if (!is_concerned(first_cell, 8, tree_.nodeChildExists(parent, inner))) continue;
      update_siblings(tree_.child(parent, inner), child_key(child_key(base, outer, 4), inner, 2), block,
                      first_cell, update);
    }
    EditableOcTree::refresh(parent);
  }
  for (unsigned depth = kBlockDepth + 1; depth-- > 0;) EditableOcTree::refresh(path[depth]);
}

void SemanticOctree::update_siblings(Node* parent, const octomap::OcTreeKey& base,
                                     const ScanGrid::Block& block, unsigned first_cell,
                                     const Update& update) {
  for (unsigned index = 0; index < 8; ++index) {
    const auto flags = block.flags[first_cell + index];
    if ((flags & kMeasured) == 0 &&
        ((flags & kNoReturnRay) == 0 || !is_uncertain(parent, index, child_key(base, index, 1), update)))
      continue;
    const bool created = !tree_.nodeChildExists(parent, index);
    const SurfaceVoxel* surface =
        (flags & kSurface) != 0 ? &update.scan.surfaces[block.slot[first_cell + index]] : nullptr;
    update_voxel(tree_.child(parent, index), created, child_key(base, index, 1), surface, update);
  }
  EditableOcTree::refresh(parent);
}

/// True for an occupied voxel that a ray without return lowers, too: a ghost, or seen seldom.
bool SemanticOctree::is_uncertain(const Node* parent, unsigned index, const octomap::OcTreeKey& key,
                                  const Update& update) const {
  if (!tree_.nodeChildExists(parent, index)) return false;
  if (!tree_.isNodeOccupied(tree_.getNodeChild(parent, index))) return false;
  if (update.history.is_ghost(key, update.time_ns)) return true;
  const auto found = voxels_.find(packed(key));
  return found != voxels_.end() && found->second.times_seen() <= kUncertainHits;
}

/// Paper §IV-C; deviation: a ray through a ghost takes kGhostMiss.
double SemanticOctree::step(bool occupied, const octomap::OcTreeKey& key, const SurfaceVoxel* surface,
                            const Update& update) const {
  if (surface != nullptr) return surface->is_hit() ? kHit : kMiss;
  return occupied && update.history.is_ghost(key, update.time_ns) ? kGhostMiss : kMiss;
}

void SemanticOctree::update_voxel(Node* node, bool created, const octomap::OcTreeKey& key,
                                  const SurfaceVoxel* surface, const Update& update) {
  const bool hit = surface != nullptr && surface->is_hit();
  const float before = node->getLogOdds();
  const auto color_before = node->getColor();
  const bool was_occupied = before > tree_.getOccupancyThresLog();
  const std::uint16_t label_before = hit && was_occupied ? this->label(key) : std::uint16_t{0};
  const auto change = static_cast<float>(step(was_occupied, key, surface, update));
  node->setLogOdds(std::clamp(before + change, lowest_, highest_));
  std::uint16_t label = 0;
  if (node->getLogOdds() > tree_.getOccupancyThresLog()) {
    label = hit ? update_semantics(node, key, *surface, update) : this->label(key);
  } else if (was_occupied) {
    voxels_.erase(packed(key));
    node->setColor(Node::Color());
  }
  const bool is_relabelled = hit && label != label_before;
  if (created || is_relabelled || node->getLogOdds() != before || node->getColor() != color_before)
    update.delta.add(key, *node, label);
}

/// True if the voxel is of an object that the detector has not found in this keyframe: no label is no vote
/// then.
bool SemanticOctree::is_of_undetected(const octomap::OcTreeKey& key, const Update& update) const {
  if (update.undetected.empty()) return false;
  const auto p = tree_.keyToCoord(key);
  const Eigen::Vector3d center(p.x(), p.y(), p.z());
  const Eigen::Vector3d voxel = Eigen::Vector3d::Constant(config_.resolution_m);
  return std::ranges::any_of(update.undetected, [&](const geometry::Box3& box) {
    return geometry::Box3{box.min - voxel, box.max + voxel}.contains(center);
  });
}

std::uint16_t SemanticOctree::update_semantics(Node* node, const octomap::OcTreeKey& key,
                                               const SurfaceVoxel& surface, const Update& update) {
  auto& voxel = voxels_[packed(key)];
  voxel.see_color(surface);
  if (update.looked_for_objects && (surface.label != 0 || !is_of_undetected(key, update)))
    voxel.vote(surface.label);
  const auto label = voxel.label(kLabelShare);
  const Rgb color = label != 0 && config_.color_by_label ? update.labels.color(label) : voxel.color();
  node->setColor(color[0], color[1], color[2]);
  return label;
}

}  // namespace rds::mapper
