// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "common/geometry/pose.hpp"

namespace rds::tracker {

/// A small motion: translation part v [m], then rotation part ω [rad].
using Twist = Eigen::Matrix<double, 6, 1>;

using Matrix6 = Eigen::Matrix<double, 6, 6>;  // of translation, then rotation, as Twist

/// [p]× with [p]× q = p × q.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& p) {
  Eigen::Matrix3d s;
  s << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
  return s;
}

/// Exponential map of SE(3).
geometry::Pose se3_exp(const Twist& twist);

/// Its inverse, for rotations below π.
Twist se3_log(const geometry::Pose& pose);

/// T · exp(ξ) = exp(Ad ξ) · T.
Matrix6 adjoint(const geometry::Pose& pose);

}  // namespace rds::tracker
