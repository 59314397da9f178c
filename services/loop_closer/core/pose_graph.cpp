// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/pose_graph.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/rotation.h>
#include <ceres/solver.h>

namespace rds::loop_closer {
namespace {

using geometry::Pose;

constexpr std::size_t kMaxCovisibleSigmaScale = 5;
constexpr double kLoopHuberSigmas = 3.0;
constexpr int kMaxIterations = 50;
constexpr double kSigmaM = 0.01;  // of the relative pose of two neighbours, and of a verified loop
constexpr double kSigmaRad = 0.005;

/// Parameters of a pose: quaternion x y z w (Eigen's order), then translation.
struct Block {
  std::array<double, 4> rotation;
  std::array<double, 3> translation;
};

Block to_block(const Pose& pose) {
  Block block{};
  Eigen::Map<Eigen::Quaterniond>(block.rotation.data()) = Eigen::Quaterniond(pose.linear()).normalized();
  Eigen::Map<Eigen::Vector3d>(block.translation.data()) = pose.translation();
  return block;
}

Pose to_pose(const Block& block) {
  return geometry::make_pose(Eigen::Map<const Eigen::Vector3d>(block.translation.data()),
                             Eigen::Map<const Eigen::Quaterniond>(block.rotation.data()));
}

class RelativePoseCost {
 public:
  RelativePoseCost(const Pose& from_from_to, double sigma_scale)
      : to_from_from_rotation_(Eigen::Quaterniond(from_from_to.linear()).normalized().conjugate()),
        translation_(from_from_to.translation()),
        inverse_sigma_m_(1 / (sigma_scale * kSigmaM)),
        inverse_sigma_rad_(1 / (sigma_scale * kSigmaRad)) {}

  template <class T>
  bool operator()(const T* from_rotation, const T* from_translation, const T* to_rotation,
                  const T* to_translation, T* residual) const {
    using Quaternion = Eigen::Quaternion<T>;
    using Vector3 = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Quaternion> q_from(from_rotation);
    const Eigen::Map<const Quaternion> q_to(to_rotation);
    const Vector3 offset =
        Eigen::Map<const Vector3>(to_translation) - Eigen::Map<const Vector3>(from_translation);
    const Quaternion estimated = q_from.conjugate() * q_to;
    const Quaternion error = to_from_from_rotation_.cast<T>() * estimated;
    const std::array<T, 4> error_wxyz{error.w(), error.x(), error.y(), error.z()};
    Eigen::Map<Vector3> translation_error(residual);
    translation_error = (q_from.conjugate() * offset - translation_.cast<T>()) * T(inverse_sigma_m_);
    ceres::QuaternionToAngleAxis(error_wxyz.data(), residual + 3);
    Eigen::Map<Vector3> rotation_error(residual + 3);
    rotation_error *= T(inverse_sigma_rad_);
    return true;
  }

 private:
  Eigen::Quaterniond to_from_from_rotation_;
  Eigen::Vector3d translation_;
  double inverse_sigma_m_;
  double inverse_sigma_rad_;
};

/// How much less a covisibility edge says than an edge between consecutive keyframes: its errors are those of
/// the chain it spans, and without this the chain would be far stiffer than drift allows.
double sigma_scale(const PoseGraphEdge& edge) {
  if (edge.kind != EdgeKind::kCovisible) return 1.0;
  const std::size_t spanned = edge.to > edge.from ? edge.to - edge.from : edge.from - edge.to;
  return static_cast<double>(std::min<std::size_t>(spanned, kMaxCovisibleSigmaScale));
}

void add_edge(ceres::Problem& problem, std::vector<Block>& blocks, const PoseGraphEdge& edge) {
  auto* cost = new ceres::AutoDiffCostFunction<RelativePoseCost, 6, 4, 3, 4, 3>(
      new RelativePoseCost(edge.from_from_to, sigma_scale(edge)));
  Block& from = blocks[edge.from];
  Block& to = blocks[edge.to];
  // A loop that is three sigmas off pulls with constant force: strong enough to close, too weak to tear.
  auto* loss = edge.kind == EdgeKind::kLoop ? new ceres::HuberLoss(kLoopHuberSigmas) : nullptr;
  problem.AddResidualBlock(cost, loss, from.rotation.data(), from.translation.data(), to.rotation.data(),
                           to.translation.data());
}

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;  // no threaded BLAS: same bits every time
  options.max_num_iterations = kMaxIterations;
  options.max_solver_time_in_seconds = 1e9;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

EdgeResidual residual_of(const PoseGraphEdge& edge, std::span<const Pose> map_from_camera) {
  const Pose error =
      edge.from_from_to.inverse() * map_from_camera[edge.from].inverse() * map_from_camera[edge.to];
  return {error.translation().norm(), geometry::rotation_angle_rad(error.linear())};
}

bool optimize_pose_graph(std::vector<Pose>& map_from_camera, std::span<const PoseGraphEdge> edges,
                         std::size_t held) {
  const auto known = [&](std::size_t i) { return i < map_from_camera.size(); };
  if (!std::all_of(edges.begin(), edges.end(),
                   [&](const auto& e) { return known(e.from) && known(e.to) && e.from != e.to; }))
    throw std::invalid_argument("pose graph: an edge joins a pose that is not there or one pose with itself");
  if (edges.empty()) return true;
  std::vector<Block> blocks(map_from_camera.size());
  std::transform(map_from_camera.begin(), map_from_camera.end(), blocks.begin(), to_block);
  ceres::Problem problem;
  for (Block& block : blocks) {
    problem.AddParameterBlock(block.rotation.data(), 4, new ceres::EigenQuaternionManifold);
    problem.AddParameterBlock(block.translation.data(), 3);
  }
  for (const PoseGraphEdge& edge : edges) add_edge(problem, blocks, edge);
  for (Block& block : std::span(blocks).first(held)) {
    problem.SetParameterBlockConstant(block.rotation.data());
    problem.SetParameterBlockConstant(block.translation.data());
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(), &problem, &summary);
  if (!summary.IsSolutionUsable()) return false;
  std::vector<Pose> optimized(blocks.size());
  std::transform(blocks.begin(), blocks.end(), optimized.begin(), to_pose);
  if (!std::all_of(optimized.begin(), optimized.end(), geometry::is_finite)) return false;
  std::copy(optimized.begin() + static_cast<std::ptrdiff_t>(held), optimized.end(),
            map_from_camera.begin() + static_cast<std::ptrdiff_t>(held));
  return true;
}

}  // namespace rds::loop_closer
