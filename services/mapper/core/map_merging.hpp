// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "common/geometry/pose_change.hpp"
#include "services/mapper/core/evidence/later_map.hpp"
#include "services/mapper/core/saved_map.hpp"

namespace rds::mapper {

/// One map of two.
struct MergedMap {
  SavedMap saved;
  VoxelChanges voxels;             // as against the earlier map
  std::size_t common_objects = 0;  // of both maps
  std::size_t gone_objects = 0;    // of the earlier one, that the later one does not have any more
};

/// Merges a saved map with one of a later time: voxels as add_later() does, labels by their names, objects by
/// place and label. An object of the earlier map most of whose voxels the later one has seen to be free has
/// gone. The direction up is the earlier map's.
///
/// @param moved  the later map's keyframes, from its frame to the earlier one's; at least one.
MergedMap merge_maps(const SavedMap& earlier, const SavedMap& later,
                     std::span<const geometry::PoseChange> moved, const MapperConfig& config);

}  // namespace rds::mapper
