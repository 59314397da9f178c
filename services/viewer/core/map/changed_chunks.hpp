// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>

#include "services/mapper/core/octree/map_delta.hpp"

namespace rds::viewer {

/// A chunk is a cube of 32 × 32 × 32 voxels.
inline constexpr unsigned kChunkBits = 5;
inline constexpr unsigned kChunkSide = 1U << kChunkBits;

/// Its index along each axis: a voxel's key without the last five bits. Packed: x << 32 | y << 16 | z.
inline std::uint64_t chunk_of(std::uint16_t x, std::uint16_t y, std::uint16_t z) {
  return std::uint64_t{static_cast<std::uint16_t>(x >> kChunkBits)} << 32 |
         std::uint64_t{static_cast<std::uint16_t>(y >> kChunkBits)} << 16 |
         static_cast<std::uint16_t>(z >> kChunkBits);
}

/// Which chunks of a map differ from what was shown of it. Bounded by the map.
struct ChangedChunks {
  bool all = false;  // chunks is of no meaning
  std::set<std::uint64_t> chunks;

  [[nodiscard]] bool empty() const { return !all && chunks.empty(); }

  /// @param applied  to the map; nullptr: the whole map is another one.
  void add(const mapper::MapDelta* applied) {
    if (applied == nullptr) all = true;
    if (all) return chunks.clear();
    add_keys(applied->keys);
    add_keys(applied->deleted_keys);
  }

 private:
  void add_keys(const std::vector<std::uint16_t>& keys) {
    for (std::size_t i = 0; i + 2 < keys.size(); i += 3)
      chunks.insert(chunk_of(keys[i], keys[i + 1], keys[i + 2]));
  }
};

}  // namespace rds::viewer
