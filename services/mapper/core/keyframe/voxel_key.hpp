// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>  // this and the next for OctoMap's header, which lacks them
#include <vector>

#include <octomap/OcTreeKey.h>

namespace rds::mapper {

// Voxels by their octree keys at the finest level, and blocks of 8×8×8 of them. Cells of a block are counted
// in the octree's child order, so that eight siblings are neighbours.

inline constexpr unsigned kBlockBits = 3;
inline constexpr std::size_t kBlockCells = 512;

/// A key in one number.
inline std::uint64_t packed(const octomap::OcTreeKey& key) {
  return std::uint64_t{key[0]} << 32 | std::uint64_t{key[1]} << 16 | key[2];
}
inline octomap::OcTreeKey unpacked(std::uint64_t key) {
  return {static_cast<std::uint16_t>(key >> 32U), static_cast<std::uint16_t>(key >> 16U),
          static_cast<std::uint16_t>(key)};
}

/// What one coordinate adds to a cell; only its lowest bits count. Not local to cell_of(): a compiler may
/// copy a local table to the stack each time.
inline constexpr std::array<std::uint16_t, 8> kSpread = {0, 1, 8, 9, 64, 65, 72, 73};  // to every third bit
inline std::uint16_t cell_along(unsigned axis, unsigned coordinate) {
  return static_cast<std::uint16_t>(kSpread[coordinate & 7U] << axis);
}
/// Of a voxel in its block.
inline std::uint16_t cell_of(const octomap::OcTreeKey& key) {
  return static_cast<std::uint16_t>(cell_along(0, key[0]) | cell_along(1, key[1]) | cell_along(2, key[2]));
}

/// Of the lowest voxel of the block around a voxel.
inline octomap::OcTreeKey block_key(const octomap::OcTreeKey& key) {
  const auto lowest = [&](unsigned axis) {
    return static_cast<std::uint16_t>(key[axis] & ~((1U << kBlockBits) - 1U));
  };
  return {lowest(0), lowest(1), lowest(2)};
}

}  // namespace rds::mapper
