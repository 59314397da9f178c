// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose.hpp"
#include "common/geometry/trajectory.hpp"

/// What a robot has sensed beside an RGB-D camera's pictures, of a recording.
namespace rds::image {

/// One measurement of an inertial measurement unit, in its own frame.
struct ImuMeasurement {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  // with gravity's reaction, as they measure [m/s²]
  Eigen::Vector3d turn_rate = Eigen::Vector3d::Zero();     // [rad/s]
};

/// An inertial measurement unit that is fixed to the camera.
struct ImuTrack {
  geometry::Pose camera_from_imu = geometry::Pose::Identity();  // the camera's optical frame
  bool has_gyroscope = true;
  std::vector<ImuMeasurement> measurements = {};  // by stamp
};

/// Odometry of a body that the camera is fixed to.
struct OdometryTrack {
  geometry::Pose body_from_camera = geometry::Pose::Identity();  // the camera's optical frame
  std::vector<geometry::StampedPose> odom_from_body = {};        // by stamp, in a frame of its own
};

struct RobotSensors {
  std::optional<ImuTrack> imu = {};
  std::optional<OdometryTrack> odometry = {};
};

}  // namespace rds::image
