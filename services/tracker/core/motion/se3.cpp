// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/se3.hpp"

#include <cmath>

namespace rds::tracker {
namespace {

constexpr double kSmallAngle = 1e-6;

/// The left Jacobian of SO(3), which carries v to the translation of the exponential.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  const Eigen::Matrix3d w = skew(omega);
  if (angle < kSmallAngle) return Eigen::Matrix3d::Identity() + 0.5 * w;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / (angle * angle) * w +
         (angle - std::sin(angle)) / (angle * angle * angle) * w * w;
}

}  // namespace

geometry::Pose se3_exp(const Twist& twist) {
  const Eigen::Vector3d omega = twist.tail<3>();
  const double angle = omega.norm();
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(omega / angle) : Eigen::Vector3d::UnitX();
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(angle, axis));
  return geometry::make_pose(left_jacobian(omega) * twist.head<3>(), rotation);
}

Twist se3_log(const geometry::Pose& pose) {
  const Eigen::AngleAxisd rotation(Eigen::Quaterniond(pose.linear()));
  Twist twist;
  twist.tail<3>() = rotation.angle() * rotation.axis();
  twist.head<3>() = left_jacobian(twist.tail<3>()).inverse() * pose.translation();
  return twist;
}

Matrix6 adjoint(const geometry::Pose& pose) {
  Matrix6 result = Matrix6::Zero();
  result.topLeftCorner<3, 3>() = pose.linear();
  result.bottomRightCorner<3, 3>() = pose.linear();
  result.topRightCorner<3, 3>() = skew(pose.translation()) * pose.linear();
  return result;
}

}  // namespace rds::tracker
