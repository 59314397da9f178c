// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unordered_map>

#include "services/mapper/core/evidence/scene_history.hpp"
#include "services/mapper/core/octree/editable_octree.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/map_delta.hpp"
#include "services/mapper/core/octree/scan.hpp"
#include "services/mapper/core/octree/semantic_voxel.hpp"

namespace rds::mapper {

/// The semantic octree of paper §IV-C: log-odds +0.85 for a voxel with static points (a hit), −0.41 for one
/// with dynamic points or that a ray passes (a miss), clamped; occupied above p = 0.5.
///
/// Each voxel changes at most once per keyframe; a hit wins over a miss. Deviations: a ray that passes a
/// ghost takes −1.2; a ray without return is a miss for uncertain voxels only (ghosts, and seldom seen ones).
/// Labels: keyframes vote on them, see SemanticVoxel.
class SemanticOctree {
 public:
  /// One keyframe's news for the octree.
  struct Update {
    const Scan& scan;
    bool looked_for_objects;
    std::vector<geometry::Box3> undetected;  // objects that the detector has not found in it
    const LabelTable& labels;
    const SceneHistory& history;
    std::int64_t time_ns;
    MapDelta& delta;  // receives what changed: arrays only
  };

  explicit SemanticOctree(const OctreeConfig& config);

  void integrate(const Update& update);

  /// Appends what turns this tree into `newer` to `delta`: changed voxels, then deleted ones, in key order of
  /// the tree.
  void difference(const SemanticOctree& newer, MapDelta& delta) const;

  /// Starts from a saved tree; its voxels have no labels. @param tree  fully expanded.
  /// @return what is wrong: another resolution; then nothing has changed.
  tl::expected<void, std::string> start_from(octomap::ColorOcTree&& tree);

  /// Tree, colours and votes of its voxels, in order of their keys.
  void put(map_file::ByteWriter& writer) const;
  /// Starts from such bytes. Refuses another resolution, and all that put() cannot have written.
  void get(map_file::ByteReader& reader, std::size_t labels);

  [[nodiscard]] const octomap::ColorOcTree& tree() const { return tree_; }
  [[nodiscard]] std::uint16_t label(const octomap::OcTreeKey& key) const;

 private:
  using Node = EditableOcTree::Node;

  void update_block(const ScanGrid::Block& block, const Update& update);
  void update_siblings(Node* parent, const octomap::OcTreeKey& base, const ScanGrid::Block& block,
                       unsigned first_cell, const Update& update);
  [[nodiscard]] bool is_uncertain(const Node* parent, unsigned index, const octomap::OcTreeKey& key,
                                  const Update& update) const;
  [[nodiscard]] double step(bool occupied, const octomap::OcTreeKey& key, const SurfaceVoxel* surface,
                            const Update& update) const;
  void update_voxel(Node* node, bool created, const octomap::OcTreeKey& key, const SurfaceVoxel* surface,
                    const Update& update);
  [[nodiscard]] bool is_of_undetected(const octomap::OcTreeKey& key, const Update& update) const;
  std::uint16_t update_semantics(Node* node, const octomap::OcTreeKey& key, const SurfaceVoxel& surface,
                                 const Update& update);

  OctreeConfig config_;
  float lowest_;  // clamping, log-odds
  float highest_;
  EditableOcTree tree_;
  std::unordered_map<std::uint64_t, SemanticVoxel> voxels_;  // looked up by key only: its order means nothing
};

}  // namespace rds::mapper
