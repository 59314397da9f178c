// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

namespace rds::image {

/// Side of the square cells [px] of which `cells` cover a picture, the last row and column perhaps in part.
/// @return 0 if no such cells do.
inline int cell_side_px(cv::Size picture, cv::Size cells) {
  if (cells.width <= 0 || cells.height <= 0 || picture.width < cells.width) return 0;
  const auto needed = [](int pixels, int side) { return (pixels + side - 1) / side; };
  const int side = needed(picture.width, cells.width);
  const bool covered =
      needed(picture.width, side) == cells.width && needed(picture.height, side) == cells.height;
  return covered ? side : 0;
}

}  // namespace rds::image
