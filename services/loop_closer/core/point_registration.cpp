// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/point_registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace rds::loop_closer {
namespace {

using geometry::Pose;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kMinTriangleArea = 1e-3;  // [m²], of three points that fix a transform
constexpr int kRefinements = 5;
constexpr int kIterations = 500;  // with a fifth of inliers, (1 − .2³)^500 = 2 % draw no triple of inliers
constexpr std::size_t kMinInliers = 20;

/// Three different indices below `count`; a 64-bit linear congruence, so that every run draws the same.
class TripleDraw {
 public:
  explicit TripleDraw(std::size_t count) : count_(count) {}

  std::array<std::size_t, 3> next() {
    std::array<std::size_t, 3> triple{draw(), draw(), draw()};
    while (triple[1] == triple[0]) triple[1] = draw();
    while (triple[2] == triple[0] || triple[2] == triple[1]) triple[2] = draw();
    return triple;
  }

 private:
  std::size_t draw() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>(state_ >> 33U) % count_;
  }

  std::size_t count_;
  std::uint64_t state_ = 0x2545F4914F6CDD1DULL;
};

std::vector<int> inliers_of(std::span<const PointPair> pairs, const Pose& candidate_from_query) {
  std::vector<int> inliers;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (agree(candidate_from_query * pairs[i].in_query, pairs[i].in_candidate))
      inliers.push_back(static_cast<int>(i));
  return inliers;
}

std::optional<Pose> from_three(std::span<const PointPair> pairs, const std::array<std::size_t, 3>& triple) {
  Eigen::Matrix3d query;
  Eigen::Matrix3d candidate;
  for (int i = 0; i < 3; ++i) {
    query.col(i) = pairs[triple[static_cast<std::size_t>(i)]].in_query;
    candidate.col(i) = pairs[triple[static_cast<std::size_t>(i)]].in_candidate;
  }
  const Eigen::Vector3d normal = (query.col(1) - query.col(0)).cross(query.col(2) - query.col(0));
  if (!(normal.norm() > 2 * kMinTriangleArea)) return std::nullopt;
  Pose pose = Pose::Identity();
  pose.matrix() = Eigen::umeyama(query, candidate, false);
  return geometry::is_finite(pose) ? std::optional(pose) : std::nullopt;
}

/// One Gauss–Newton step of the rays and inverse depths; the perturbation multiplies from the left.
Pose refined_once(std::span<const PointPair> pairs, const std::vector<int>& inliers, const Pose& pose) {
  // A third of the gates: what is at the gate is three standard deviations off.
  const Eigen::Vector3d inverse_sigma =
      3.0 * Eigen::Vector3d(1 / kMaxRayError, 1 / kMaxRayError, 1 / kMaxInverseDepthError);
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  for (const int i : inliers) {
    const Eigen::Vector3d p = pose * pairs[static_cast<std::size_t>(i)].in_query;
    const Eigen::Vector3d& q = pairs[static_cast<std::size_t>(i)].in_candidate;
    const double w = 1 / p.z();
    const Eigen::Vector3d error = inverse_sigma.cwiseProduct(
        Eigen::Vector3d(p.x() * w - q.x() / q.z(), p.y() * w - q.y() / q.z(), w - 1 / q.z()));
    Eigen::Matrix3d by_point;
    by_point << w, 0, -p.x() * w * w, 0, w, -p.y() * w * w, 0, 0, -w * w;
    Eigen::Matrix<double, 3, 6> point_by_pose;
    point_by_pose << Eigen::Matrix3d::Identity(),
        -(Eigen::Matrix3d() << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0).finished();
    const Eigen::Matrix<double, 3, 6> jacobian = inverse_sigma.asDiagonal() * by_point * point_by_pose;
    const double huber = std::min(1.0, 1.0 / std::max(error.norm(), 1e-12));
    hessian += huber * jacobian.transpose() * jacobian;
    gradient += huber * jacobian.transpose() * error;
  }
  hessian.diagonal().array() += 1e-9;
  const Vector6d step = -hessian.ldlt().solve(gradient);
  if (!step.allFinite()) return pose;
  const Eigen::Vector3d rotation = step.tail<3>();
  Pose delta = Pose::Identity();
  if (rotation.norm() > 0)
    delta.linear() = Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
  delta.translation() = step.head<3>();
  return geometry::make_pose((delta * pose).translation(), Eigen::Quaterniond((delta * pose).linear()));
}

}  // namespace

bool agree(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  if (!(a.z() > 0) || !(b.z() > 0)) return false;
  return std::abs(a.x() / a.z() - b.x() / b.z()) <= kMaxRayError &&
         std::abs(a.y() / a.z() - b.y() / b.z()) <= kMaxRayError &&
         std::abs(1 / a.z() - 1 / b.z()) <= kMaxInverseDepthError;
}

std::optional<Registration> register_points(std::span<const PointPair> pairs) {
  if (pairs.size() < kMinInliers) return std::nullopt;
  TripleDraw draw(pairs.size());
  Registration best;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const auto pose = from_three(pairs, draw.next());
    if (!pose) continue;
    auto inliers = inliers_of(pairs, *pose);
    if (inliers.size() > best.inliers.size()) best = {*pose, std::move(inliers)};
  }
  if (best.inliers.size() < 4) return std::nullopt;
  best = refine_registration(pairs, best.candidate_from_query);
  if (best.inliers.size() < kMinInliers) return std::nullopt;
  return best;
}

Registration refine_registration(std::span<const PointPair> pairs, const Pose& candidate_from_query) {
  Registration registration{candidate_from_query, inliers_of(pairs, candidate_from_query)};
  for (int i = 0; i < kRefinements && registration.inliers.size() >= 4; ++i) {
    const Pose refined = refined_once(pairs, registration.inliers, registration.candidate_from_query);
    auto inliers = inliers_of(pairs, refined);
    if (inliers.size() < registration.inliers.size() * 9 / 10) break;  // diverged
    registration = {refined, std::move(inliers)};
  }
  return registration;
}

}  // namespace rds::loop_closer
