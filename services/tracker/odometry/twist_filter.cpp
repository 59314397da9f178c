// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/odometry/twist_filter.hpp"

#include <Eigen/Cholesky>

namespace rds::tracker {
namespace {

constexpr double kLongestGapS = 1;  // that a speed is told over
// Of a body whose speed is not known yet.
constexpr double kUnknownMPerS = 1;
constexpr double kUnknownRadPerS = 1;
// Spectral density of the acceleration [m²/s³, rad²/s³]: 0.3 m/s² and 0.6 rad/s² that last 0.05 s, as a
// hand's and a robot's do.
constexpr double kAcceleration = 0.01;
constexpr double kTurnAcceleration = 0.03;

Matrix6 diagonal(double translation, double rotation) {
  Twist values;
  values << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
  return values.asDiagonal();
}

Matrix6 unknown() {
  return diagonal(kUnknownMPerS * kUnknownMPerS, kUnknownRadPerS * kUnknownRadPerS);
}

}  // namespace

Matrix6 TwistFilter::covariance() const {
  return state_ ? Matrix6(state_->covariance.bottomRightCorner<6, 6>()) : unknown();
}

void TwistFilter::step(std::int64_t stamp_ns, const geometry::Pose& parent_from_body, const Matrix6& noise) {
  const double s = state_ ? 1e-9 * static_cast<double>(stamp_ns - state_->stamp_ns) : 0;
  if (s <= 0 || s > kLongestGapS) {
    state_ = State{stamp_ns, parent_from_body, Twist::Zero(), Matrix12::Zero()};
    state_->covariance.topLeftCorner<6, 6>() = noise;
    state_->covariance.bottomRightCorner<6, 6>() = unknown();
    return;
  }
  state_->stamp_ns = stamp_ns;
  predict(s, *state_);
  update(parent_from_body, noise, *state_);
}

void TwistFilter::predict(double s, State& state) {
  const geometry::Pose step = se3_exp(s * state.twist);
  state.pose = state.pose * step;
  Matrix12 transition = Matrix12::Identity();
  transition.topLeftCorner<6, 6>() = adjoint(step.inverse());
  transition.topRightCorner<6, 6>() = s * Matrix6::Identity();
  const Matrix6 density = diagonal(kAcceleration, kTurnAcceleration);
  state.covariance = (transition * state.covariance * transition.transpose()).eval();
  state.covariance.topLeftCorner<6, 6>() += s * s * s / 3 * density;
  state.covariance.topRightCorner<6, 6>() += s * s / 2 * density;
  state.covariance.bottomLeftCorner<6, 6>() += s * s / 2 * density;
  state.covariance.bottomRightCorner<6, 6>() += s * density;
}

void TwistFilter::update(const geometry::Pose& measured, const Matrix6& noise, State& state) {
  const Twist innovation = se3_log(state.pose.inverse() * measured);
  const Matrix6 expected = state.covariance.topLeftCorner<6, 6>() + noise;
  const Eigen::Matrix<double, 12, 6> gain = expected.ldlt().solve(state.covariance.topRows<6>()).transpose();
  const Eigen::Matrix<double, 12, 1> correction = gain * innovation;
  state.pose = state.pose * se3_exp(correction.head<6>());
  // Products of rotations drift from orthonormality.
  state.pose = geometry::make_pose(state.pose.translation(), Eigen::Quaterniond(state.pose.linear()));
  state.twist += correction.tail<6>();
  state.covariance -= (gain * state.covariance.topRows<6>()).eval();
  state.covariance = (state.covariance + state.covariance.transpose()).eval() / 2;
}

}  // namespace rds::tracker
