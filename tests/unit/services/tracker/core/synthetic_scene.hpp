// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "common/image/rgbd_frame.hpp"
#include "services/tracker/core/map/slam_map.hpp"
#include "services/tracker/core/removal/movable_mask.hpp"

namespace rds::tracker::test {

/// 320×240 camera without distortion.
geometry::CameraModel small_camera();

/// Rotation about the camera's y axis [rad] and translation [m].
Pose pose(double x, double y, double z, double turn_rad = 0);

/// A hand-held camera's: 0.3 m/s and 50 degrees per second.
Twist quick_motion();

/// What a camera sees of a wall with random texture at z = 2 m; depth in metres.
/// @param relief_m  every other strip of 0.7 m stands out so far.
image::RgbdFrame picture_of_wall(const Pose& map_from_camera, std::int64_t stamp_ns,
                                 const geometry::CameraModel& camera = small_camera(), double relief_m = 0);

/// A mask of the small camera's picture that covers these pixels.
MovableMask mask_of(const cv::Rect& px);

/// The same camera with its lens covered.
image::RgbdFrame dark_picture(std::int64_t stamp_ns);

/// Random points in front of the origin, 1.5 … 3 m away.
std::vector<Eigen::Vector3d> random_points(std::size_t count, std::mt19937& random);

/// Features where a camera sees the points (those in the picture), with random descriptors made from the
/// point's index, so that the same point looks the same to every camera.
/// @param motion  of the camera while its rows are read; the features are as measured, not compensated.
struct SyntheticView {
  std::shared_ptr<const FeatureSet> features;
  std::vector<std::size_t> point;  // per feature: index into the points
};
SyntheticView view_of(const std::vector<Eigen::Vector3d>& points, const Pose& map_from_camera,
                      double noise_px, std::mt19937& random, const ShutterMotion& motion = {});

}  // namespace rds::tracker::test
