// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/removal/depth_grid.hpp"

namespace rds::tracker {

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

}  // namespace rds::tracker
