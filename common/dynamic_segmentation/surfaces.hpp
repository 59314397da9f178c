// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "common/dynamic_segmentation/depth_grid.hpp"

namespace rds::segmentation {

/// True if two neighbouring cells with these depths [m] can show one surface.
/// @param step_m  largest step 1 m away; beyond, it grows with depth squared, as a slanted surface's does.
inline bool one_surface(float depth_a_m, float depth_b_m, double step_m) {
  const float nearer = std::min(depth_a_m, depth_b_m);
  return std::abs(depth_a_m - depth_b_m) <= static_cast<float>(step_m) * std::max(1.0F, nearer * nearer);
}

/// The surfaces that a picture shows, cell by cell. Depth [m] and grid must outlive it.
struct SurfaceCells {
  const cv::Mat1f& depth_m;
  const GridGeometry& grid;

  /// In the camera frame.
  [[nodiscard]] Eigen::Vector3f point(int column, int row) const {
    return depth_m(row, column) * grid.ray(column, row);
  }
  /// Of the surface between the four neighbours, of any length; zero where they are not of one surface.
  [[nodiscard]] Eigen::Vector3f normal(int column, int row) const;
};

}  // namespace rds::segmentation
