// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <unordered_map>

#include "services/mapper/core/editable_octree.hpp"
#include "services/mapper/core/tree_bytes.hpp"
#include "services/mapper/core/types.hpp"

namespace rds::mapper {

/// Why an update was not applied.
enum class ReplicaStatus {
  kApplied,
  kOld,         // the replica is there already, or beyond; nothing to do
  kGap,         // a delta was missed: wait for the next full map
  kOtherEpoch,  // of another map: wait for its full map
  kOtherResolution,
  kMalformed,  // arrays that do not fit each other, values that are no log-odds: dropped
};

struct ReplicaAnswer {
  ReplicaStatus status = ReplicaStatus::kApplied;
  std::string reason;  // one sentence unless applied
};

/// A reader's copy of the map: full map plus deltas give a tree identical to the mapper's, voxel by voxel,
/// value by value.
///
/// A rejected update changes nothing. Pure: any program that receives the two topics can use it.
class OctreeReplica {
 public:
  /// Takes a full map (octomap_msgs payload). Labels are told from colours, exactly, by the label table.
  ReplicaAnswer apply_full(std::span<const std::uint8_t> payload, double resolution_m,
                           std::uint64_t map_epoch, std::uint64_t revision,
                           std::span<const std::string> labels);

  ReplicaAnswer apply(const MapDelta& delta);

  /// False until the first full map, or the delta that starts an epoch, was applied.
  [[nodiscard]] bool is_valid() const { return tree_ != nullptr; }
  /// @pre is_valid()
  [[nodiscard]] const octomap::ColorOcTree& tree() const { return *tree_; }
  [[nodiscard]] std::uint16_t label(const octomap::OcTreeKey& key) const;
  [[nodiscard]] std::uint64_t map_epoch() const { return map_epoch_; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

 private:
  [[nodiscard]] ReplicaAnswer check(const MapDelta& delta) const;
  void set_voxels(const MapDelta& delta);
  void delete_voxels(const MapDelta& delta);

  std::unique_ptr<EditableOcTree> tree_;
  std::unordered_map<std::uint64_t, std::uint16_t> labels_;  // of labelled voxels; looked up by key only
  std::uint64_t map_epoch_ = 0;
  std::uint64_t revision_ = 0;
};

}  // namespace rds::mapper
