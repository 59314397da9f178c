// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/lens.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace rds::geometry {
namespace {

/// Radial by a quotient of polynomials, and tangential.
Eigen::Vector2d bend_rational(const std::array<double, 8>& k, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm();
  const double radial =
      (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  const double xy = p.x() * p.y();
  return {p.x() * radial + 2 * k[2] * xy + k[3] * (r2 + 2 * p.x() * p.x()),
          p.y() * radial + k[2] * (r2 + 2 * p.y() * p.y()) + 2 * k[3] * xy};
}

/// r of the picture is a polynomial of the angle to the optical axis.
Eigen::Vector2d bend_equidistant(const std::array<double, 8>& k, const Eigen::Vector2d& p) {
  const double r = p.norm();
  if (r < 1e-9) return p;
  const double angle = std::atan(r);
  const double a2 = angle * angle;
  const double bent = angle * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
  return p * (bent / r);
}

}  // namespace

Eigen::Vector2d Lens::project(const Eigen::Vector3d& point_in_camera) const {
  const Eigen::Vector2d p = point_in_camera.head<2>() / point_in_camera.z();
  const Eigen::Vector2d bent =
      model == LensModel::kEquidistant ? bend_equidistant(coefficients, p) : bend_rational(coefficients, p);
  return {fx * bent.x() + cx, fy * bent.y() + cy};
}

std::optional<Eigen::Vector3d> Lens::ray(const Eigen::Vector2d& pixel) const {
  constexpr int kIterations = 20;
  constexpr double kExactPx = 1e-3;
  constexpr double kStep = 1e-5;       // of the derivatives
  constexpr double kLeastArea = 0.01;  // of a pixel, to that of the pinhole's
  const auto projected = [this](double x, double y) { return project({x, y, 1}); };
  Eigen::Vector2d at((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::Vector2d off = pixel - projected(at.x(), at.y());
    Eigen::Matrix2d derivative;
    derivative << (projected(at.x() + kStep, at.y()) - projected(at.x() - kStep, at.y())) / (2 * kStep),
        (projected(at.x(), at.y() + kStep) - projected(at.x(), at.y() - kStep)) / (2 * kStep);
    const bool is_folded = !(derivative.determinant() > kLeastArea * fx * fy);
    if (is_folded) return std::nullopt;
    if (off.norm() < kExactPx) return Eigen::Vector3d(at.x(), at.y(), 1);
    at += derivative.inverse() * off;
  }
  return std::nullopt;
}

CameraModel Lens::camera() const {
  CameraModel camera{.width = width, .height = height, .fx = fx, .fy = fy, .cx = cx, .cy = cy};
  if (is_plain()) std::copy_n(coefficients.begin(), camera.distortion.size(), camera.distortion.begin());
  return camera;
}

}  // namespace rds::geometry
