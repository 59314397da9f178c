// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/alignment.hpp"

#include <algorithm>
#include <stdexcept>

#include <Eigen/SVD>

namespace rds::geometry {
namespace {
constexpr double kSmallestVariance = 1e-12;

Eigen::Vector3d mean_of(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

using Svd = Eigen::JacobiSVD<Eigen::Matrix3d>;

/// Eq. (43): no mirror image.
Eigen::Vector3d signs_of(const Svd& svd) {
  return {1, 1, svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1.0 : 1.0};
}

/// The rotation R for which trace(R · Hᵀ) is largest.
Eigen::Matrix3d rotation_of(const Svd& svd) {
  return svd.matrixU() * signs_of(svd).asDiagonal() * svd.matrixV().transpose();
}

void expect_pairs(std::size_t sources, std::size_t targets) {
  if (sources == 0 || sources != targets)
    throw std::invalid_argument("to align, as many source as target points, at least one, are needed");
}
}  // namespace

RigidAlignment align_rigid(std::span<const Eigen::Vector3d> source, std::span<const Eigen::Vector3d> target) {
  expect_pairs(source.size(), target.size());
  const Eigen::Vector3d source_mean = mean_of(source);
  const Eigen::Vector3d target_mean = mean_of(target);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double source_variance = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    covariance += (target[i] - target_mean) * (source[i] - source_mean).transpose();
    source_variance += (source[i] - source_mean).squaredNorm();
  }
  const Svd svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  RigidAlignment result;
  result.target_from_source.linear() = rotation_of(svd);
  result.target_from_source.translation() = target_mean - result.target_from_source.linear() * source_mean;
  result.similarity_scale = svd.singularValues().dot(signs_of(svd)) / std::max(source_variance, kSmallestVariance);
  return result;
}

Pose align_orientations(std::span<const Pose> source, std::span<const Pose> target) {
  expect_pairs(source.size(), target.size());
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  Eigen::Vector3d source_sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) {
    turned += target[i].linear() * source[i].linear().transpose();
    source_sum += source[i].translation();
    target_sum += target[i].translation();
  }
  Pose result = Pose::Identity();
  result.linear() = rotation_of(Svd(turned, Eigen::ComputeFullU | Eigen::ComputeFullV));
  result.translation() =
      (target_sum - result.linear() * source_sum) / static_cast<double>(source.size());
  return result;
}

}  // namespace rds::geometry
