// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unordered_map>

#include "services/mapper/core/config/mapper_config.hpp"
#include "services/mapper/core/evidence/evidence_block.hpp"
#include "services/mapper/core/octree/editable_octree.hpp"
#include "services/mapper/core/octree/key_bounds.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/map_delta.hpp"

namespace rds::mapper {

/// The semantic octree of paper §IV-C, as the evidence has it: log-odds of the voxels that are known, colours
/// and labels of those that are occupied.
class SemanticOctree {
 public:
  explicit SemanticOctree(const OctreeConfig& config);

  /// Takes over some voxels of a block, those that may have changed. @param key  of its lowest voxel.
  /// @param delta  receives what changed: arrays only.
  void show(const octomap::OcTreeKey& key, const EvidenceBlock& block, const BlockMask& voxels,
            const LabelTable& labels, MapDelta& delta);

  [[nodiscard]] const octomap::ColorOcTree& tree() const { return tree_; }
  [[nodiscard]] std::uint64_t occupied() const { return occupied_; }  // voxels
  /// Of all voxels. The tree must have one.
  [[nodiscard]] const KeyBounds& bounds() const { return bounds_; }
  [[nodiscard]] std::uint16_t label(const octomap::OcTreeKey& key) const;

 private:
  using Node = EditableOcTree::Node;
  struct Source {
    const EvidenceBlock& block;
    const BlockMask& voxels;
    const LabelTable& labels;
    MapDelta& delta;
  };
  struct Voxel {
    float value;
    Node::Color color;
    std::uint16_t label;
  };

  bool show_children(Node* parent, const octomap::OcTreeKey& key, unsigned first_cell, unsigned half,
                     const Source& source);
  bool show_voxel(Node* parent, unsigned index, const octomap::OcTreeKey& key, unsigned cell,
                  const Source& source);
  void erase_voxel(Node* parent, unsigned index, const octomap::OcTreeKey& key, const Source& source);
  [[nodiscard]] Voxel voxel_of(unsigned cell, const Source& source) const;
  void set_label(const octomap::OcTreeKey& key, std::uint16_t label);

  OctreeConfig config_;
  EditableOcTree tree_;
  std::unordered_map<std::uint64_t, PerCell<std::uint16_t>> labels_;  // of blocks where some voxel bore one
  std::uint64_t occupied_ = 0;
  KeyBounds bounds_;
};

}  // namespace rds::mapper
