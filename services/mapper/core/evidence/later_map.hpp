// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "services/mapper/core/evidence/final_map.hpp"
#include "services/mapper/core/evidence/map_motion.hpp"

namespace rds::mapper {

/// A map of a later time, and how it lies in an earlier one.
struct LaterMap {
  const FinalMap& voxels;
  MapMotion motion;
  std::span<const std::uint16_t> label_of;  // the earlier table's index of each label of the later table
};

/// Voxels that are others than in the earlier map.
struct VoxelChanges {
  std::size_t appeared = 0;  // occupied now
  std::size_t vanished = 0;  // not occupied any more
};

/// What both maps say of space, the later one having been there later.
///
/// A voxel of the earlier map's grid is what the voxel of the later map around its middle is:
///
///   L ← clamp(L_earlier + L_later)        Eq. (2) of the paper, whose sum L_later is; so what has stood for
///                                         long is gone after five misses, what is put somewhere is there
///                                         after three hits, as in the evidence of one map
///   L ← L_later                           where that is clamped: it may stand for any number of keyframes
///
/// Grids that are turned to each other do not meet: a surface of the earlier map stays where any voxel of the
/// later one that it touches is not free. Colours and votes on labels are sums.
FinalMap add_later(const FinalMap& earlier, const LaterMap& later, double voxel_m, VoxelChanges& changes);

}  // namespace rds::mapper
