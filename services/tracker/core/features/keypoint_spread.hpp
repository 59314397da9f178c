// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace rds::tracker {

/// A corner of one pyramid level.
struct Corner {
  float x = 0;  // [px] of the level
  float y = 0;
  float score = 0;
};

/// Chooses at most `wanted` corners so that they cover the picture evenly: a quadtree splits the cell with
/// the largest product of corners and area until there are `wanted` cells, then every cell keeps its
/// strongest corner.
///
/// @param corners  inside [0, width) × [0, height); reordered.
/// @return the chosen ones in a fixed order; all of them if there are no more than `wanted`.
/// Source: Mur-Artal et al. 2015, §III-B asks for homogeneous coverage; the tree is our own.
std::vector<Corner> spread_evenly(std::vector<Corner>& corners, float width, float height,
                                  std::size_t wanted);

}  // namespace rds::tracker
