// SPDX-License-Identifier: Apache-2.0
#include "tests/support/odometry_consistency.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Cholesky>

namespace rds::test {
namespace {

using geometry::Pose;
using tracker::Twist;

constexpr std::int64_t kNsAround = 10'000'000;  // that the true speed is taken over, to each side

/// log of a rotation [rad].
Eigen::Vector3d rotation_log(const Eigen::Matrix3d& rotation) {
  return tracker::se3_log(geometry::make_pose(Eigen::Vector3d::Zero(), Eigen::Quaterniond(rotation)))
      .tail<3>();
}

double normalised(const auto& error, const auto& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

/// The camera's speed in its own frame, by central difference.
std::optional<Twist> true_twist(std::span<const geometry::StampedPose> truth, std::int64_t stamp_ns) {
  if (stamp_ns - kNsAround < truth.front().stamp_ns || stamp_ns + kNsAround > truth.back().stamp_ns)
    return std::nullopt;
  const Pose before = geometry::interpolate(truth, stamp_ns - kNsAround);
  const Pose after = geometry::interpolate(truth, stamp_ns + kNsAround);
  return Twist(tracker::se3_log(before.inverse() * after) / (2e-9 * static_cast<double>(kNsAround)));
}

}  // namespace

void OdometryConsistency::add(std::int64_t stamp_ns, const tracker::FrameResult& result) {
  if (!has_pose(result.state)) return;
  const tracker::RobotFrames camera{"camera", "camera"};
  const tracker::OdometryStep step = odometry_.step(
      {stamp_ns, result.map_from_camera, result.information, result.state != tracker::State::kRelocalised,
       true, result.carried_covariance, result.map_covariance},
      camera);
  const Pose world_from_camera = geometry::interpolate(truth_, stamp_ns);
  const Pose& told = step.parent_from_child;
  if (!odom_from_world_) {
    odom_from_world_ = told * world_from_camera.inverse();
    return;
  }
  const Pose truth = *odom_from_world_ * world_from_camera;
  Twist off;
  off << told.translation() - truth.translation(), rotation_log(told.linear() * truth.linear().transpose());
  const tracker::Matrix6& covariance = step.pose_covariance;
  OdometryError error;
  error.nees = normalised(off, covariance);
  error.nees_translation =
      normalised(Eigen::Vector3d(off.head<3>()), Eigen::Matrix3d(covariance.topLeftCorner<3, 3>()));
  error.nees_rotation =
      normalised(Eigen::Vector3d(off.tail<3>()), Eigen::Matrix3d(covariance.bottomRightCorner<3, 3>()));
  error.position_m = off.head<3>().norm();
  error.rotation_rad = off.tail<3>().norm();
  error.told_position_m = std::sqrt(covariance.topLeftCorner<3, 3>().trace());
  error.told_rotation_rad = std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
  if (const auto twist = true_twist(truth_, stamp_ns); twist && errors_.size() > 5) {
    const Twist wrong = step.twist - *twist;
    error.speed_m_per_s = wrong.head<3>().norm();
    error.turn_rad_per_s = wrong.tail<3>().norm();
    error.twist_nees = normalised(wrong, step.twist_covariance);
  }
  errors_.push_back(error);
}

double mean_of(std::span<const OdometryError> errors, double OdometryError::*part) {
  double sum = 0;
  for (const OdometryError& error : errors) sum += error.*part;
  return sum / static_cast<double>(errors.size());
}

double median_of(std::span<const OdometryError> errors, std::optional<double> OdometryError::*part) {
  std::vector<double> values;
  for (const OdometryError& error : errors)
    if (error.*part) values.push_back(*(error.*part));
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::nth_element(values, values.begin() + std::ssize(values) / 2);
  return values[values.size() / 2];
}

}  // namespace rds::test
