// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/camera_model.hpp"
#include "services/tracker/core/features/feature.hpp"
#include "services/tracker/core/motion/se3.hpp"

namespace rds::tracker {

/// How a camera moved while its picture was read, first row to last. The frame's pose is that of its middle
/// row.
struct ShutterMotion {
  Twist velocity = Twist::Zero();  // per second; the scene moves through the camera's frame by v + ω×p
  double readout_s = 0;            // from the first row to the last; 0: all at once
};

/// Velocity [m/s] of a still point p [m] in the camera's frame.
[[nodiscard]] inline Eigen::Vector3d point_velocity(const Twist& velocity, const Eigen::Vector3d& p) {
  return velocity.head<3>() + velocity.tail<3>().cross(p);
}

/// When a row is read, as a share of the readout time after the middle row: −½ at the top, ½ at the bottom.
[[nodiscard]] inline double row_share(const geometry::CameraModel& camera, double row_px) {
  return (row_px + 0.5) / camera.height - 0.5;
}

/// Moves features (px, depth_m) to where they would be had all rows been read with the middle one; image_px
/// stays. First order in time; a feature without depth follows the rotation only.
/// Source: the idea of Klein & Murray 2009 (PTAM on a camera phone).
void remove_rolling_shutter(const geometry::CameraModel& camera, const ShutterMotion& motion,
                            std::vector<Feature>& features);

/// Pixel of the picture at which a camera-frame point of the middle row's time [m, z > 0] shows when its own
/// row is read. First order in time.
[[nodiscard]] Eigen::Vector2d project_rolling(const geometry::CameraModel& camera,
                                              const ShutterMotion& motion, const Eigen::Vector3d& p);

/// Velocity [m/s] at which the point that a feature sees moves through the camera's frame, times the share of
/// the readout time at which its row was read: by how much, per second of readout, the feature is off.
/// Zero for a feature without depth.
[[nodiscard]] Eigen::Vector3d shutter_effect(const geometry::CameraModel& camera, const Twist& velocity,
                                             const Feature& feature);

}  // namespace rds::tracker
