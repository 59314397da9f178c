// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/geometry/pose.hpp"
#include "services/tracker/core/removal/depth_grid.hpp"
#include "services/tracker/core/removal/removal_config.hpp"

namespace rds::tracker {

/// What an earlier picture saw.
struct SeenCells {
  /// @param pose  map_from_camera.
  /// @param mask  not 0 where something movable showed, its rim included: says nothing. May be empty.
  SeenCells(const cv::Mat1f& depth_m, const cv::Mat1b& mask, const GridGeometry& grid,
            const geometry::Pose& pose);

  Eigen::ArrayX3f points;  // in the camera frame
  geometry::Pose map_from_camera;
};

/// What earlier pictures say of the cells of a new one. Both have the new picture's size.
struct MotionEvidence {
  cv::Mat1b arrived;   // 255 where something stands nearer than what stood there before
  cv::Mat1b standing;  // 255 where stands what stood there before, and had nothing to do with what moves
};

/// Compares depths: what an earlier picture saw is moved to where the camera is now and shows up there.
///
/// A cell is judged by all that comes to lie in its 3×3 neighbourhood, so that a pose that is wrong by a cell
/// changes nothing. Parts that the earlier picture knew as movable say nothing.
MotionEvidence compare_with_past(const cv::Mat1f& depth_m, const GridGeometry& grid,
                                 const geometry::Pose& camera_from_map, std::span<const SeenCells> past,
                                 const RemovalConfig& config);

/// The things that have arrived, as far as they were seen to arrive. What is small is noise; where too much
/// of what can be judged has arrived the pose is wrong, and there is nothing.
std::vector<std::vector<cv::Point>> moving_objects(const cv::Mat1f& depth_m, const MotionEvidence& evidence,
                                                   const RemovalConfig& config);

}  // namespace rds::tracker
