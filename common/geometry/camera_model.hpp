// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

namespace rds::geometry {

/// Pinhole camera with radial-tangential distortion (k1 k2 p1 p2 k3), depth registered to colour.
///
/// Pixels: centre of the top-left pixel is (0, 0). Camera frame: x right, y down, z forward (REP-103
/// optical).
struct CameraModel {
  int width = 0;
  int height = 0;
  double fx = 0;
  double fy = 0;
  double cx = 0;
  double cy = 0;
  std::array<double, 5> distortion{};

  [[nodiscard]] bool has_distortion() const;

  /// True for positive sizes and focal lengths and finite values.
  [[nodiscard]] bool is_valid() const;

  /// Camera-frame point [m] with z > 0 to its (distorted) image pixel.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& point_in_camera) const;

  /// Camera-frame point [m] with z > 0 to the pixel an ideal camera without distortion would see it at.
  [[nodiscard]] Eigen::Vector2d project_undistorted(const Eigen::Vector3d& point_in_camera) const;

  /// Derivative of project_undistorted() by the point [px/m].
  [[nodiscard]] Eigen::Matrix<double, 2, 3> undistorted_by_point(
      const Eigen::Vector3d& point_in_camera) const;

  /// Image pixel (distorted) to the pixel of the ideal camera with the same fx fy cx cy.
  [[nodiscard]] Eigen::Vector2d undistort(const Eigen::Vector2d& pixel) const;

  /// Ray (x, y, 1) of an undistorted pixel; multiply by depth z [m] for the point.
  [[nodiscard]] Eigen::Vector3d ray_of_undistorted(const Eigen::Vector2d& undistorted_pixel) const;

  /// Ray (x, y, 1) of an image pixel.
  [[nodiscard]] Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const {
    return ray_of_undistorted(undistort(pixel));
  }

  bool operator==(const CameraModel&) const = default;
};

}  // namespace rds::geometry
