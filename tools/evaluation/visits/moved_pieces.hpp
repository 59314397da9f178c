// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "tools/evaluation/voxels/voxel_set.hpp"

namespace rds::evaluation {

/// Voxels of `all` that have none of `others` within `radius` voxels.
VoxelSet away_from(const VoxelSet& others, const VoxelSet& all, int radius);

/// Parts of a set that hang together (26 neighbours), of at least `smallest` voxels.
/// @return of each part, indices in the set, ascending.
std::vector<std::vector<std::size_t>> connected_parts(const VoxelSet& voxels, std::size_t smallest);

}  // namespace rds::evaluation
