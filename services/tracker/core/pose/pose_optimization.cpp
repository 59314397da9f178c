// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/pose_optimization.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/core/pose/robust_loss.hpp"

namespace rds::tracker {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr int kRounds = 4;               // each ends with a new classification into inliers and outliers
constexpr int kIterations = 10;          // per round, at most
constexpr double kConvergedStep = 1e-7;  // m and rad
constexpr double kFirstDamping = 1e-5;
constexpr double kMaxDamping = 1e3;
constexpr int kMinObservations = 3;
constexpr double kUnknownSigma = 0.1;  // m and rad, of what there is no information about

struct NormalEquations {
  Matrix6 hessian = Matrix6::Zero();
  Twist gradient = Twist::Zero();
  double cost = 0;
};

class PoseProblem {
 public:
  PoseProblem(const ObservationModel& model, std::span<const PointObservation> observations)
      : model_(model), observations_(observations), inlier_(observations.size(), true) {}

  [[nodiscard]] NormalEquations linearize(const geometry::Pose& pose, bool robust) const {
    NormalEquations sum;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      if (!inlier_[i]) continue;
      const Measurement& m = observations_[i].measurement;
      const Eigen::Vector3d p = pose * observations_[i].point_in_map;
      const double bound = ObservationModel::chi2(m);
      if (p.z() < kMinDepth) {
        sum.cost += observations_[i].weight * bound;
        continue;
      }
      const Eigen::Vector3d r = model_.residual(p, m);
      Eigen::Matrix<double, 3, 6> j;
      j.leftCols<3>() = model_.jacobian(p, m);
      j.rightCols<3>() = -j.leftCols<3>() * skew(p);  // d(exp(ξ) p) / dω = −[p]×
      RobustLoss l = robust_loss(r.squaredNorm(), bound, robust);
      l.weight *= observations_[i].weight;
      l.cost *= observations_[i].weight;
      sum.hessian.noalias() += l.weight * j.transpose() * j;
      sum.gradient.noalias() += l.weight * j.transpose() * r;
      sum.cost += l.cost;
    }
    return sum;
  }

  /// @return the information at the pose.
  Matrix6 optimize(geometry::Pose& pose, bool robust) const {
    double damping = kFirstDamping;
    NormalEquations equations = linearize(pose, robust);
    for (int i = 0; i < kIterations; ++i) {
      Matrix6 damped = equations.hessian;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += 1e-9;
      const Twist step = damped.ldlt().solve(-equations.gradient);
      if (!step.allFinite()) break;
      const geometry::Pose moved = se3_exp(step) * pose;
      const NormalEquations there = linearize(moved, robust);
      if (there.cost < equations.cost) {
        pose = moved;
        equations = there;
        if (step.norm() < kConvergedStep) break;
        damping = std::max(damping * 0.1, 1e-9);
      } else {
        damping *= 10;
        if (damping > kMaxDamping || step.norm() < kConvergedStep) break;
      }
    }
    return equations.hessian;
  }

  int classify(const geometry::Pose& pose) {
    int inliers = 0;
    for (std::size_t i = 0; i < observations_.size(); ++i) {
      const Measurement& m = observations_[i].measurement;
      const Eigen::Vector3d p = pose * observations_[i].point_in_map;
      inlier_[i] = p.z() > kMinDepth && model_.residual(p, m).squaredNorm() <= ObservationModel::chi2(m);
      inliers += inlier_[i] ? 1 : 0;
    }
    return inliers;
  }

  std::vector<bool> take_inliers() { return std::move(inlier_); }

 private:
  const ObservationModel& model_;
  std::span<const PointObservation> observations_;
  std::vector<bool> inlier_;
};

}  // namespace

OptimizedPose optimize_pose(const ObservationModel& model, std::span<const PointObservation> observations,
                            const geometry::Pose& camera_from_map) {
  OptimizedPose result;
  result.camera_from_map = camera_from_map;
  result.inlier.assign(observations.size(), false);
  if (observations.size() < kMinObservations) return result;
  PoseProblem problem(model, observations);
  for (int round = 0; round < kRounds; ++round) {
    result.information = problem.optimize(result.camera_from_map, 2 * round < kRounds);
    result.inliers = problem.classify(result.camera_from_map);
    if (result.inliers < kMinObservations) break;
  }
  result.inlier = problem.take_inliers();
  // Accumulated products of rotations drift from orthonormality.
  result.camera_from_map = geometry::make_pose(result.camera_from_map.translation(),
                                               Eigen::Quaterniond(result.camera_from_map.linear()));
  return result;
}

Matrix6 pose_covariance(const Matrix6& information) {
  const Matrix6 regular = information + Matrix6::Identity() / (kUnknownSigma * kUnknownSigma);
  const Matrix6 covariance = regular.ldlt().solve(Matrix6::Identity());
  return (covariance + covariance.transpose()) / 2;
}

OptimizedPose check_pose(const ObservationModel& model, std::span<const PointObservation> observations,
                         const geometry::Pose& camera_from_map) {
  PoseProblem problem(model, observations);
  OptimizedPose result;
  result.camera_from_map = camera_from_map;
  result.inliers = problem.classify(camera_from_map);
  result.inlier = problem.take_inliers();
  return result;
}

}  // namespace rds::tracker
