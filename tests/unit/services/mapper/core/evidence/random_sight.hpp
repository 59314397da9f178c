// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "services/mapper/core/evidence/keyframe_view.hpp"

namespace rds::mapper::test {

/// Of each cell one observation or none, and now and then something dynamic near it.
inline BlockSight random_sight(std::mt19937& random) {
  BlockSight sight;
  const std::array<BlockMask*, 5> observations{&sight.no_return, &sight.passed, &sight.unknown,
                                               &sight.doubtful, &sight.stable};
  for (std::size_t cell = 0; cell < kBlockCells; ++cell) {
    const unsigned which = random() % 16U;
    if (which > 0) observations[which <= observations.size() ? which - 1 : 1]->insert(cell);  // mostly passed
    if (random() % 8U == 0) sight.near_dynamic.insert(cell);
  }
  return sight;
}

/// All surfaces of a block are of one surface of the picture.
inline std::vector<SurfacePart> parts_of(const BlockSight& sight) {
  std::vector<SurfacePart> parts;
  sight.surfaces().for_each([&](std::size_t) { parts.push_back({1, 0}); });
  return parts;
}

/// One of four kinds in any colour for each static or doubtful voxel.
inline std::vector<SurfaceLook> looks_of(const BlockSight& sight, std::mt19937& random) {
  std::vector<SurfaceLook> looks;
  sight.seen_static().for_each([&](std::size_t) {
    const auto label = static_cast<std::uint16_t>(random() % 3U);
    const auto beside = static_cast<std::uint16_t>(label == 0 ? random() % 2U : 0U);
    looks.push_back({{static_cast<std::uint8_t>(random()), 10, 20}, label, true, {beside}});
  });
  return looks;
}

}  // namespace rds::mapper::test
