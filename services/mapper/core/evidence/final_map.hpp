// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "services/mapper/core/evidence/occupancy_model.hpp"
#include "services/mapper/core/evidence/voxel_look.hpp"

namespace rds::mapper {

/// What is final in a block: it comes before all keyframes that are not.
struct FinalBlock {
  BlockOccupancy occupancy;
  BlockCounts counts;
  std::map<std::uint16_t, VoxelLook> looks;  // by cell

  /// Adds a voxel that counts as seen at all times. @param look  of an occupied one.
  void add(std::uint16_t cell, LogOdds log_odds, const VoxelLook& look);
};

/// What is final in a map, by the key of the block's lowest voxel.
struct FinalMap {
  std::map<std::uint64_t, std::shared_ptr<const FinalBlock>> blocks;
  std::optional<std::int64_t> origin_ms;  // that the blocks' times count from; nullopt: they count from none

  /// Log-odds of a voxel; nullptr if nothing is known of it.
  [[nodiscard]] const LogOdds* value(const octomap::OcTreeKey& voxel) const;
  /// Of an occupied voxel; nullptr of any other.
  [[nodiscard]] const VoxelLook* look(const octomap::OcTreeKey& voxel) const;

  void put(map_file::ByteWriter& writer) const;
  /// @param labels  of the label table. Refuses what put() cannot have written.
  static FinalMap get(map_file::ByteReader& reader, std::size_t labels);
};

}  // namespace rds::mapper
