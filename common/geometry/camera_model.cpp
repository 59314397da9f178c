// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/camera_model.hpp"

#include <algorithm>
#include <cmath>

namespace rds::geometry {
namespace {

/// Brown–Conrady distortion of a normalised image point.
Eigen::Vector2d distort(const std::array<double, 5>& d, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm();
  const double radial = 1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  const double xy = p.x() * p.y();
  return {p.x() * radial + 2 * d[2] * xy + d[3] * (r2 + 2 * p.x() * p.x()),
          p.y() * radial + d[2] * (r2 + 2 * p.y() * p.y()) + 2 * d[3] * xy};
}

constexpr int kUndistortIterations = 20;

}  // namespace

bool CameraModel::has_distortion() const {
  return std::ranges::any_of(distortion, [](double k) { return k != 0; });
}

bool CameraModel::is_valid() const {
  const bool finite = std::isfinite(fx) && std::isfinite(fy) && std::isfinite(cx) && std::isfinite(cy) &&
                      std::ranges::all_of(distortion, [](double k) { return std::isfinite(k); });
  return finite && width > 0 && height > 0 && fx > 0 && fy > 0;
}

Eigen::Vector2d CameraModel::project(const Eigen::Vector3d& point_in_camera) const {
  Eigen::Vector2d p = point_in_camera.head<2>() / point_in_camera.z();
  if (has_distortion()) p = distort(distortion, p);
  return {fx * p.x() + cx, fy * p.y() + cy};
}

Eigen::Vector2d CameraModel::project_undistorted(const Eigen::Vector3d& point_in_camera) const {
  const Eigen::Vector2d p = point_in_camera.head<2>() / point_in_camera.z();
  return {fx * p.x() + cx, fy * p.y() + cy};
}

Eigen::Matrix<double, 2, 3> CameraModel::undistorted_by_point(const Eigen::Vector3d& p) const {
  const double inverse_z = 1 / p.z();
  Eigen::Matrix<double, 2, 3> derivative;
  derivative << fx, 0, -fx * p.x() * inverse_z, 0, fy, -fy * p.y() * inverse_z;
  return inverse_z * derivative;
}

Eigen::Vector2d CameraModel::undistort(const Eigen::Vector2d& pixel) const {
  if (!has_distortion()) return pixel;
  const Eigen::Vector2d observed((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  Eigen::Vector2d p = observed;  // fixed-point iteration: p = observed − (distort(p) − p)
  for (int i = 0; i < kUndistortIterations; ++i) {
    const Eigen::Vector2d before = p;
    p += observed - distort(distortion, p);
    if (p == before) break;
  }
  return {fx * p.x() + cx, fy * p.y() + cy};
}

Eigen::Vector3d CameraModel::ray_of_undistorted(const Eigen::Vector2d& undistorted_pixel) const {
  return {(undistorted_pixel.x() - cx) / fx, (undistorted_pixel.y() - cy) / fy, 1.0};
}

}  // namespace rds::geometry
