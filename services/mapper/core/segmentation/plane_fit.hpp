// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Eigenvalues>

namespace rds::mapper {

/// Points p with normal · p = offset.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit
  double offset_m = 0;

  /// Signed [m].
  [[nodiscard]] double distance_m(const Eigen::Vector3d& point) const { return normal.dot(point) - offset_m; }
};

/// Points by their sums, so that parts add up to a whole.
class PointSums {
 public:
  void add(const Eigen::Vector3d& p) {
    ++count_;
    sum_ += p;
    squares_ += p.cwiseProduct(p);
    mixed_ += Eigen::Vector3d(p.x() * p.y(), p.x() * p.z(), p.y() * p.z());
  }
  void add(const PointSums& other) {
    count_ += other.count_;
    sum_ += other.sum_;
    squares_ += other.squares_;
    mixed_ += other.mixed_;
  }

  [[nodiscard]] double count() const { return count_; }
  [[nodiscard]] Eigen::Vector3d mean() const { return sum_ / count_; }

  /// The plane of least squares.
  [[nodiscard]] Plane plane() const {
    const Eigen::Vector3d normal = axes().eigenvectors().col(0);
    return {normal, normal.dot(mean())};
  }
  /// Standard deviation of the points along the narrower side of their plane [m].
  [[nodiscard]] double narrow_deviation_m() const {
    return std::sqrt(std::max(0.0, axes().eigenvalues()(1)));
  }
  /// Root mean square of the points' distances from a plane [m].
  [[nodiscard]] double deviation_m(const Plane& plane) const {
    const double variance = plane.normal.dot(covariance() * plane.normal);
    return std::sqrt(std::max(0.0, variance) + std::pow(plane.distance_m(mean()), 2));
  }

 private:
  [[nodiscard]] Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes() const {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance());
    return solver;
  }
  [[nodiscard]] Eigen::Matrix3d covariance() const {
    Eigen::Matrix3d products;
    products << squares_.x(), mixed_[0], mixed_[1],  //
        mixed_[0], squares_.y(), mixed_[2],          //
        mixed_[1], mixed_[2], squares_.z();
    return products / count_ - mean() * mean().transpose();
  }

  double count_ = 0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares_ = Eigen::Vector3d::Zero();  // Σ x², y², z²
  Eigen::Vector3d mixed_ = Eigen::Vector3d::Zero();    // Σ xy, xz, yz
};

}  // namespace rds::mapper
