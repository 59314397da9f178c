// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/odometry/odometry.hpp"

#include "services/tracker/core/pose/pose_optimization.hpp"

namespace rds::tracker {
namespace {

// Of a frame's covariance, what is new in its error and not in that of the frame before: residuals have a
// third of the standard deviations that poses are found with, which also stand for what the errors of points
// have in common.
constexpr double kNewShare = 0.1;
constexpr double kCarriedM =
    0.003;  // that odometry which carries a pose on errs by from frame to frame, and …
constexpr double kCarriedRad = 0.003;

Matrix6 carried_noise() {
  Twist values;
  values << Eigen::Vector3d::Constant(kCarriedM * kCarriedM),
      Eigen::Vector3d::Constant(kCarriedRad * kCarriedRad);
  return values.asDiagonal();
}

/// About the axes of the parent, as nav_msgs/Odometry has it.
Matrix6 about_parent(const Matrix6& covariance, const geometry::Pose& parent_from_child) {
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = parent_from_child.linear();
  turn.bottomRightCorner<3, 3>() = parent_from_child.linear();
  return turn * covariance * turn.transpose();
}

}  // namespace

Matrix6 covariance_in_child(const Matrix6& in_camera, const geometry::Pose& child_from_camera) {
  const Matrix6 moved = adjoint(child_from_camera);
  const Matrix6 covariance = moved * in_camera * moved.transpose();
  return (covariance + covariance.transpose()) / 2;
}

geometry::Pose Odometry::camera_on_body_at_rest(const RobotFrames& frames) const {
  if (frames.body != body_) return odom_from_camera_;
  return odom_from_camera_ * body_from_camera_.inverse() * frames.body_from_camera;
}

OdometryStep Odometry::step(const TrackedPose& pose, const RobotFrames& frames) {
  if (!pose.is_continuous || joins_) {
    map_from_odom_ = pose.map_from_camera * camera_on_body_at_rest(frames).inverse();
    speed_.reset();
  }
  joins_ = false;
  odom_from_camera_ = map_from_odom_.inverse() * pose.map_from_camera;
  body_ = frames.body;
  body_from_camera_ = frames.body_from_camera;
  OdometryStep step;
  step.is_in_map = frames.odom_from_camera.has_value();
  if (frames.map_to_odom_is_ours && pose.is_placed)
    step.map_from_odom =
        step.is_in_map ? pose.map_from_camera * frames.odom_from_camera->inverse() : map_from_odom_;
  if (frames.odom_to_body_is_ours)
    step.odom_from_body = odom_from_camera_ * frames.body_from_camera.inverse();
  const geometry::Pose camera_from_child = frames.child_from_camera.inverse();
  step.parent_from_child = (step.is_in_map ? pose.map_from_camera : odom_from_camera_) * camera_from_child;
  const Matrix6 found = pose_covariance(pose.information);
  const Matrix6 covariance =
      covariance_in_child(pose.covariance.value_or(found + pose.map_covariance), frames.child_from_camera);
  step.pose_covariance = about_parent(covariance, step.parent_from_child);
  if (frames.child != child_) speed_.reset();
  child_ = frames.child;
  speed_.step(pose.stamp_ns, odom_from_camera_ * camera_from_child,
              covariance_in_child(pose.covariance ? carried_noise() : Matrix6(kNewShare * found),
                                  frames.child_from_camera));
  step.twist = speed_.twist();
  step.twist_covariance = speed_.covariance();
  return step;
}

}  // namespace rds::tracker
