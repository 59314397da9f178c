// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <stop_token>
#include <utility>

#include <ceres/ceres.h>

#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/core/pose/observation_model.hpp"

/// Bundle adjustment as Ceres sees it. Read by bundle_adjustment.cpp alone.
namespace rds::tracker {

using PoseBlock = std::array<double, 7>;  // camera_from_map: qx qy qz qw x y z

inline PoseBlock to_block(const geometry::Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

inline geometry::Pose to_pose(const double* block) {
  return geometry::make_pose({block[4], block[5], block[6]},
                             Eigen::Quaterniond(block[3], block[0], block[1], block[2]));
}

/// camera_from_map ⊞ ξ = exp(ξ) · camera_from_map. Cost functions give derivatives by ξ in the first six
/// columns, so the manifold's own derivative only drops the seventh.
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const geometry::Pose moved = se3_exp(Eigen::Map<const Twist>(delta)) * to_pose(x);
    std::ranges::copy(to_block(moved), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> j(jacobian);
    j.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Twist> difference(y_minus_x);
    difference = se3_log(to_pose(y) * to_pose(x).inverse());
    return true;
  }
  bool MinusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> j(jacobian);
    j.setIdentity();
    return true;
  }
};

class ReprojectionCost final : public ceres::SizedCostFunction<3, 7, 3> {
 public:
  /// @param shift  of the weighted residual.
  ReprojectionCost(const ObservationModel& model, const Measurement& measurement,
                   const Eigen::Vector3d& shift)
      : model_(model), measurement_(measurement), shift_(shift) {}

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const geometry::Pose camera_from_map = to_pose(parameters[0]);
    const Eigen::Vector3d p = camera_from_map * Eigen::Map<const Eigen::Vector3d>(parameters[1]);
    if (p.z() < kMinDepth) return false;
    Eigen::Map<Eigen::Vector3d> r(residuals);
    r = model_.residual(p, measurement_) + shift_;
    if (jacobians == nullptr) return true;
    const Eigen::Matrix3d by_point = model_.jacobian(p, measurement_);
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 7, Eigen::RowMajor>> j(jacobians[0]);
      j.leftCols<3>() = by_point;
      j.middleCols<3>(3) = -by_point * skew(p);
      j.col(6).setZero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> j(jacobians[1]);
      j = by_point * camera_from_map.linear();
    }
    return true;
  }

 private:
  ObservationModel model_;
  Measurement measurement_;
  Eigen::Vector3d shift_;
};

/// Ends the solver when it is told to stop.
class StopCallback final : public ceres::IterationCallback {
 public:
  explicit StopCallback(std::stop_token stop) : stop_(std::move(stop)) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    return stop_.stop_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
  }

 private:
  std::stop_token stop_;
};

/// The same bits every time: one thread, no threaded BLAS, no time limit.
inline ceres::Solver::Options solver_options(int iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = iterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace rds::tracker
