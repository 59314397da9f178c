// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "services/mapper/core/evidence/block_mask.hpp"

namespace rds::mapper {

/// Milliseconds, from a keyframe of the map on.
using EvidenceTime = std::int32_t;
inline constexpr EvidenceTime kBeforeAll = std::numeric_limits<EvidenceTime>::min() / 2;
inline constexpr EvidenceTime kAfterAll = std::numeric_limits<EvidenceTime>::max() / 2;

template <class Value>
using PerCell = std::array<Value, kBlockCells>;

/// How often, and when first and last, keyframes have seen something in the voxels of a block.
struct Sightings {
  PerCell<std::uint32_t> count{};
  PerCell<EvidenceTime> first = filled(kAfterAll);
  PerCell<EvidenceTime> last = filled(kBeforeAll);
  // Where the keyframe that was first or last has gone: the times have to be looked up again, with
  // look_up(); until then they are those of that keyframe.
  BlockMask first_is_open;
  BlockMask last_is_open;

  void add(const BlockMask& cells, EvidenceTime time);
  /// What was added before.
  void remove(const BlockMask& cells, EvidenceTime time);

  static PerCell<EvidenceTime> filled(EvidenceTime time) {
    PerCell<EvidenceTime> cells;
    cells.fill(time);
    return cells;
  }
};

/// How often and when keyframes have seen the voxels of a block as what.
struct BlockCounts {
  Sightings statics;   // static or doubtful
  Sightings dynamics;  // something dynamic was there
};

/// Whether a voxel was seen as static so long before or after a time.
/// @param apart  by then something dynamic would have moved.
inline bool seen_apart(const BlockCounts& counts, std::size_t cell, EvidenceTime time, EvidenceTime apart) {
  return counts.statics.first[cell] <= time - apart || counts.statics.last[cell] >= time + apart;
}

/// Whether a voxel was static in fewer keyframes than dynamic, and only while something dynamic was there.
bool is_transient(const BlockCounts& counts, std::size_t cell, EvidenceTime apart);

}  // namespace rds::mapper
