// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <unordered_map>

#include "services/mapper/core/octree/editable_octree.hpp"
#include "services/mapper/core/octree/map_delta.hpp"
#include "services/mapper/core/octree/tree_bytes.hpp"

namespace rds::mapper {

/// Why an update was not applied.
enum class ReplicaStatus {
  kApplied,
  kOld,       // the replica is there already, or beyond; nothing to do
  kGap,       // a delta was missed: wait for the next full map
  kOtherMap,  // of another epoch, or a mapper that began anew: wait for its full map
  kOtherResolution,
  kMalformed,  // arrays that do not fit each other, values that are no log-odds: dropped
};

struct ReplicaAnswer {
  ReplicaStatus status = ReplicaStatus::kApplied;
  std::string reason;  // one sentence unless applied
};

/// A full map, as rds/map/full and the rds/map/info of the same stamp tell it.
struct FullMap {
  std::span<const std::uint8_t> payload;  // of octomap_msgs/Octomap
  double resolution = 0;                  // [m]
  std::uint64_t map_epoch = 0;
  std::uint64_t map_id = 0;
  std::uint64_t revision = 0;
  std::span<const std::string> labels;          // label table
  std::span<const std::uint16_t> label_keys{};  // 3N, voxels whose colour does not tell their label
  std::span<const std::uint16_t> label_values{};
};

/// A reader's copy of the map: full map plus deltas give a tree identical to the mapper's, voxel by voxel,
/// value by value.
///
/// A rejected update changes nothing. Pure: any program that receives the two topics can use it.
class OctreeReplica {
 public:
  /// Takes a full map: one that is newer, or of another map than the replica's (a mapper that was restarted).
  ReplicaAnswer apply(const FullMap& full);
  ReplicaAnswer apply(const MapDelta& delta);

  /// False until the first full map, or the delta that starts an epoch, was applied.
  [[nodiscard]] bool is_valid() const { return tree_ != nullptr; }
  /// @pre is_valid()
  [[nodiscard]] const octomap::ColorOcTree& tree() const { return *tree_; }
  [[nodiscard]] std::uint16_t label(const octomap::OcTreeKey& key) const;
  [[nodiscard]] std::uint64_t map_epoch() const { return map_epoch_; }
  [[nodiscard]] std::uint64_t map_id() const { return map_id_; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

 private:
  /// True if the replica is of this map.
  [[nodiscard]] bool is_of(std::uint64_t map_epoch, std::uint64_t map_id) const;
  [[nodiscard]] ReplicaAnswer check(const FullMap& full) const;
  [[nodiscard]] ReplicaAnswer check(const MapDelta& delta) const;
  void take_labels(const FullMap& full);
  void set_label(const octomap::OcTreeKey& key, std::uint16_t label);
  void set_voxels(const MapDelta& delta);
  void delete_voxels(const MapDelta& delta);

  std::unique_ptr<EditableOcTree> tree_;
  std::unordered_map<std::uint64_t, std::uint16_t> labels_;  // of labelled voxels; looked up by key only
  std::uint64_t map_epoch_ = 0;
  std::uint64_t map_id_ = 0;
  std::uint64_t revision_ = 0;
};

}  // namespace rds::mapper
