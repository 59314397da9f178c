// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace rds::geometry {

/// A rigid transform. Variables are named by cancellation: map_from_camera * point_in_camera = point_in_map.
using Pose = Eigen::Isometry3d;

/// Pose from translation [m] and rotation; the quaternion is normalised.
inline Pose make_pose(const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

inline bool is_finite(const Pose& pose) {
  return pose.matrix().allFinite();
}

/// Rotation angle [rad], 0 … π.
inline double rotation_angle_rad(const Eigen::Matrix3d& rotation) {
  return Eigen::AngleAxisd(rotation).angle();
}

}  // namespace rds::geometry
