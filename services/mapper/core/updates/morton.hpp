// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <octomap/OcTreeKey.h>

namespace rds::mapper {

/// A key's bits interleaved: in this order, which is that of for_each_voxel(), neighbours mostly follow each
/// other.
inline std::uint64_t morton_of(const octomap::OcTreeKey& key) {
  const auto spread = [](std::uint64_t v) {
    v = (v | v << 32) & 0xFFFF00000000FFFF;
    v = (v | v << 16) & 0x00FF0000FF0000FF;
    v = (v | v << 8) & 0xF00F00F00F00F00F;
    v = (v | v << 4) & 0x30C30C30C30C30C3;
    return (v | v << 2) & 0x9249249249249249;
  };
  return spread(key[0]) | spread(key[1]) << 1 | spread(key[2]) << 2;
}

/// The reverse. @param code  below kMortonEnd.
inline octomap::OcTreeKey key_of_morton(std::uint64_t code) {
  const auto gather = [](std::uint64_t v) {
    v &= 0x9249249249249249;
    v = (v | v >> 2) & 0x30C30C30C30C30C3;
    v = (v | v >> 4) & 0xF00F00F00F00F00F;
    v = (v | v >> 8) & 0x00FF0000FF0000FF;
    v = (v | v >> 16) & 0xFFFF00000000FFFF;
    return static_cast<std::uint16_t>(v | v >> 32);
  };
  return {gather(code), gather(code >> 1), gather(code >> 2)};
}

inline constexpr std::uint64_t kMortonEnd = std::uint64_t{1} << 48;

}  // namespace rds::mapper
