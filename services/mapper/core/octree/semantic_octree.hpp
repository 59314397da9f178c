// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unordered_map>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"
#include "services/mapper/core/evidence/scene_history.hpp"
#include "services/mapper/core/octree/editable_octree.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/map_delta.hpp"
#include "services/mapper/core/octree/scan.hpp"

namespace rds::mapper {

/// What an occupied voxel remembers besides its log-odds.
class VoxelMemory {
 public:
  void see_color(const SurfaceVoxel& surface);
  /// One vote per keyframe that looked for objects; label 0 votes against all.
  void vote(std::uint16_t label);
  /// The label with most votes if it has the needed share, else 0; ties go to the lower index.
  [[nodiscard]] std::uint16_t label(double needed_share) const;
  [[nodiscard]] Rgb color() const;
  [[nodiscard]] int times_seen() const { return times_seen_; }

  void put(map_file::ByteWriter& writer) const;
  /// @param labels  of the label table. Refuses colours and labels that cannot be.
  static VoxelMemory get(map_file::ByteReader& reader, std::size_t labels);

 private:
  struct Votes {
    std::uint16_t label = 0;
    std::uint16_t count = 0;
  };
  std::array<float, 3> mean_rgb_{};
  std::uint16_t times_seen_ = 0;
  std::uint16_t votes_cast_ = 0;
  std::array<Votes, 3> votes_{};
};

/// The semantic octree of paper §IV-C: log-odds +0.85 where a static point was seen, −0.41 where a movable
/// point was seen or a ray passed, clamped; occupied above p = 0.5. Where a ray should have met an occupied
/// voxel and nothing was measured, −0.41 too, if few keyframes have seen the voxel. A ray through an occupied
/// voxel that is suspect (SceneHistory) takes more: something movable that the detector missed now and then.
/// Each voxel changes at most once per keyframe, hits win over misses.
class SemanticOctree {
 public:
  /// One keyframe's news for the octree.
  struct Update {
    const Scan& scan;
    bool looked_for_objects;
    std::vector<geometry::Box3> unsighted;  // objects that it says nothing about
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

  /// Tree and what its voxels remember, in order of their keys.
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
  [[nodiscard]] bool is_weak(const Node* parent, unsigned index, const octomap::OcTreeKey& key,
                             const Update& update) const;
  [[nodiscard]] double step(bool occupied, const octomap::OcTreeKey& key, const SurfaceVoxel* surface,
                            const Update& update) const;
  void update_voxel(Node* node, bool created, const octomap::OcTreeKey& key, const SurfaceVoxel* surface,
                    const Update& update);
  [[nodiscard]] bool is_of_unsighted(const octomap::OcTreeKey& key, const Update& update) const;
  std::uint16_t remember(Node* node, const octomap::OcTreeKey& key, const SurfaceVoxel& surface,
                         const Update& update);

  OctreeConfig config_;
  float lowest_;  // clamping, log-odds
  float highest_;
  EditableOcTree tree_;
  std::unordered_map<std::uint64_t, VoxelMemory> memory_;  // looked up by key only: its order means nothing
};

}  // namespace rds::mapper
