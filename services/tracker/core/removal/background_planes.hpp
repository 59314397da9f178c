// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "services/tracker/core/removal/depth_grid.hpp"

namespace rds::tracker {

/// Points p with normal · p = distance, camera frame [m].
struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float distance = 0;
  bool wide = false;  // wider than a person: a table, a wall, the floor
};

/// Large planes (a table, a wall, the floor) among cells of a picture, found by RANSAC, the largest first.
/// The same cells give the same planes.
std::vector<Plane> find_planes(const cv::Mat1f& depth_m, const GridGeometry& grid,
                               const std::vector<cv::Point>& cells);

/// True if a cell lies on the plane and its surface is parallel to it.
bool lies_on(const Plane& plane, const cv::Mat1f& depth_m, const GridGeometry& grid, const cv::Point& cell);

}  // namespace rds::tracker
