// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/dynamic_segmentation/depth_grid.hpp"

namespace rds::segmentation::test {

/// Cells of 2 px of a camera without distortion.
inline const GridGeometry& small_grid() {
  static const GridGeometry grid(
      {.width = 320, .height = 240, .fx = 260, .fy = 260, .cx = 159.5, .cy = 119.5}, {});
  return grid;
}

}  // namespace rds::segmentation::test
