// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/motion/se3.hpp"

namespace rds::tracker {

/// By what a robot's odometry is to be multiplied: its way, and its turning. Wheels of another radius, or
/// another distance between them, than the robot believes.
using OdometryScale = Eigen::Vector2d;

/// The way of a robot's body from some moment on, by the steps that its odometry tells, and how far it is
/// known.
///
/// A step ξ = (v, ω) is truly exp(Sξ) exp(n), S = diag(s_v, s_v, s_v, s_ω, s_ω, s_ω). The noise n grows with
/// way, turning and time, as slip and rough ground cause it; scale errors add up along the way. First order.
class OdometryPath {
 public:
  /// @param step  of the body, as told. @param scale  as known now. @param step_s  that it took.
  void extend(const Twist& step, const OdometryScale& scale, double step_s);

  [[nodiscard]] const geometry::Pose& begin_from_end() const { return begin_from_end_; }
  /// How the end moves in its own frame with the scale.
  [[nodiscard]] const Eigen::Matrix<double, 6, 2>& by_scale() const { return by_scale_; }
  /// Covariance of the end, in its own frame, if the scale is right.
  [[nodiscard]] const Matrix6& noise() const { return noise_; }
  /// The same with a scale that is known with this covariance.
  [[nodiscard]] Matrix6 covariance(const Eigen::Matrix2d& scale_covariance) const {
    return noise_ + by_scale_ * scale_covariance * by_scale_.transpose();
  }
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double turned_rad() const { return turned_rad_; }
  [[nodiscard]] double duration_s() const { return duration_s_; }

 private:
  geometry::Pose begin_from_end_ = geometry::Pose::Identity();
  Eigen::Matrix<double, 6, 2> by_scale_ = Eigen::Matrix<double, 6, 2>::Zero();
  Matrix6 noise_ = Matrix6::Zero();
  double length_m_ = 0;
  double turned_rad_ = 0;
  double duration_s_ = 0;
};

}  // namespace rds::tracker
