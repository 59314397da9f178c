// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/relocalization/relief.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace rds::tracker {

double relief_of(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& camera) {
  if (points.empty()) return 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    sum += point;
    squares += point * point.transpose();
  }
  const auto count = static_cast<double>(points.size());
  const Eigen::Vector3d mean = sum / count;
  const Eigen::Matrix3d covariance = squares / count - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, axes.eigenvalues()[0])) / (mean - camera).norm();
}

}  // namespace rds::tracker
