// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/dynamic_segmentation/depth_grid.hpp"
#include "common/geometry/pose.hpp"

namespace rds::segmentation {

/// What an earlier picture saw.
struct SeenCells {
  /// @param pose  map_from_camera.
  /// @param mask  not 0 in cells to leave out: something movable showed there. May be empty.
  SeenCells(const cv::Mat1f& depth_m, const cv::Mat1b& mask, const GridGeometry& grid,
            const geometry::Pose& pose);

  Eigen::ArrayX3f points;  // in the camera frame
  geometry::Pose map_from_camera;
};

/// What earlier pictures say of the cells of a new one. Both have the new picture's size, or are empty.
struct MotionEvidence {
  cv::Mat1b appeared;   // 255 where something stands nearer than what stood there before
  cv::Mat1b unchanged;  // 255 where the same surface shows as before
};

/// Compares depths: what an earlier picture saw is projected into the camera where it is now.
///
/// A cell is compared with all that projects into its 3×3 neighbourhood, so that a pose that is wrong by a
/// cell changes nothing. At least two earlier pictures have to agree that something has appeared, and what is
/// thinner than 5 cells is noise. Nothing is said if more than 40 % of the cells that can be compared have
/// appeared: then the pose is wrong.
MotionEvidence compare_with_past(const cv::Mat1f& depth_m, const GridGeometry& grid,
                                 const geometry::Pose& camera_from_map, std::span<const SeenCells> past);

}  // namespace rds::segmentation
