// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/odometry/odometry.hpp"

#include <Eigen/Cholesky>

namespace rds::tracker {
namespace {

// A pose without information is one by depth alone, which may be off by as much as the tracker lets pass.
constexpr double kUnknownM = 0.1;
constexpr double kUnknownRad = 0.1;
constexpr std::int64_t kLongestGapNs = 1'000'000'000;  // that a speed is told over
// Of a robot whose speed is not known yet.
constexpr double kUnknownMPerS = 1;
constexpr double kUnknownRadPerS = 1;

Matrix6 diagonal(double translation, double rotation) {
  Twist values;
  values << Eigen::Vector3d::Constant(translation * translation),
      Eigen::Vector3d::Constant(rotation * rotation);
  return values.asDiagonal();
}

/// T · exp(ξ) = exp(Ad ξ) · T.
Matrix6 adjoint(const geometry::Pose& pose) {
  Matrix6 result = Matrix6::Zero();
  result.topLeftCorner<3, 3>() = pose.linear();
  result.bottomRightCorner<3, 3>() = pose.linear();
  result.topRightCorner<3, 3>() = skew(pose.translation()) * pose.linear();
  return result;
}

/// About the axes of the parent, as nav_msgs/Odometry has it.
Matrix6 about_parent(const Matrix6& covariance, const geometry::Pose& parent_from_child) {
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = parent_from_child.linear();
  turn.bottomRightCorner<3, 3>() = parent_from_child.linear();
  return turn * covariance * turn.transpose();
}

}  // namespace

Matrix6 covariance_of(const Matrix6& information, const geometry::Pose& child_from_camera) {
  const Matrix6 regular = information + Matrix6(diagonal(1 / kUnknownM, 1 / kUnknownRad));
  const Matrix6 in_camera = regular.ldlt().solve(Matrix6::Identity());
  const Matrix6 moved = adjoint(child_from_camera);
  const Matrix6 covariance = moved * in_camera * moved.transpose();
  return (covariance + covariance.transpose()) / 2;
}

OdometryStep Odometry::step(const TrackedPose& pose, const RobotFrames& frames) {
  if (!pose.is_continuous || joins_) {
    map_from_odom_ = pose.map_from_camera * odom_from_camera_.inverse();
    past_.clear();
  }
  joins_ = false;
  odom_from_camera_ = map_from_odom_.inverse() * pose.map_from_camera;
  OdometryStep step;
  step.is_in_map = frames.odom_from_camera.has_value();
  if (frames.map_to_odom_is_ours && pose.is_placed)
    step.map_from_odom =
        step.is_in_map ? pose.map_from_camera * frames.odom_from_camera->inverse() : map_from_odom_;
  if (frames.odom_to_body_is_ours)
    step.odom_from_body = odom_from_camera_ * frames.body_from_camera.inverse();
  const geometry::Pose camera_from_child = frames.child_from_camera.inverse();
  step.parent_from_child = (step.is_in_map ? pose.map_from_camera : odom_from_camera_) * camera_from_child;
  const Matrix6 covariance = covariance_of(pose.information, frames.child_from_camera);
  step.pose_covariance = about_parent(covariance, step.parent_from_child);
  if (frames.child != child_) past_.clear();
  child_ = frames.child;
  tell_speed({pose.stamp_ns, odom_from_camera_ * camera_from_child, covariance}, step);
  return step;
}

void Odometry::tell_speed(const Past& now, OdometryStep& step) {
  if (!past_.empty() &&
      (past_.back().stamp_ns >= now.stamp_ns || past_.back().stamp_ns < now.stamp_ns - kLongestGapNs))
    past_.clear();
  while (past_.size() > 1 && past_[1].stamp_ns <= now.stamp_ns - kWindowNs) past_.pop_front();
  step.twist_covariance = diagonal(kUnknownMPerS, kUnknownRadPerS);
  if (!past_.empty()) {
    const Past& then = past_.front();
    const double s = static_cast<double>(now.stamp_ns - then.stamp_ns) * 1e-9;
    step.twist = se3_log(then.odom_from_child.inverse() * now.odom_from_child) / s;
    step.twist_covariance = (then.covariance + now.covariance) / (s * s);
  }
  past_.push_back(now);
}

}  // namespace rds::tracker
