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
}  // namespace

RigidAlignment align_rigid(std::span<const Eigen::Vector3d> source, std::span<const Eigen::Vector3d> target) {
  if (source.empty() || source.size() != target.size())
    throw std::invalid_argument("align_rigid: as many source as target points, at least one, are needed");
  const Eigen::Vector3d source_mean = mean_of(source);
  const Eigen::Vector3d target_mean = mean_of(target);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double source_variance = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    covariance += (target[i] - target_mean) * (source[i] - source_mean).transpose();
    source_variance += (source[i] - source_mean).squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();  // Eq. (43): no mirror image
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign.z() = -1;
  RigidAlignment result;
  result.target_from_source.linear() = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  result.target_from_source.translation() = target_mean - result.target_from_source.linear() * source_mean;
  result.similarity_scale = svd.singularValues().dot(sign) / std::max(source_variance, kSmallestVariance);
  return result;
}

}  // namespace rds::geometry
