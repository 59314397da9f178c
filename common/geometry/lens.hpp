// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "common/geometry/camera_model.hpp"

namespace rds::geometry {

/// How a lens bends the rays of a pinhole camera; as the drivers' camera_info names them.
enum class LensModel {
  kPlumbBob,            // k1 k2 p1 p2 k3
  kRationalPolynomial,  // k1 k2 p1 p2 k3 k4 k5 k6
  kEquidistant          // k1 k2 k3 k4, of the angle to the optical axis
};

/// A camera as it was calibrated. Where CameraModel knows no such lens, pictures are resampled to those of an
/// ideal pinhole camera (image::LensTable). Source: Brown 1971 (plumb bob); Claus & Fitzgibbon 2005
/// (rational); Kannala & Brandt 2006 (equidistant).
struct Lens {
  int width = 0;
  int height = 0;
  double fx = 0;
  double fy = 0;
  double cx = 0;
  double cy = 0;
  LensModel model = LensModel::kPlumbBob;
  std::array<double, 8> coefficients{};

  /// Where the lens shows a point of the camera's frame [m], z > 0: image pixel.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& point_in_camera) const;

  /// Ray (x, y, 1) that the lens shows at an image pixel, by Newton's method from the pinhole's; nullopt
  /// where there is none: the distortion does not reach so far, or folds back.
  [[nodiscard]] std::optional<Eigen::Vector3d> ray(const Eigen::Vector2d& pixel) const;

  /// Whether CameraModel says the same: camera() is then the camera of its pictures as they are.
  [[nodiscard]] bool is_plain() const { return model == LensModel::kPlumbBob; }

  /// The camera of its pictures: as they are if the lens is plain, else after resampling, without distortion
  /// and with the same size, fx, fy, cx and cy.
  [[nodiscard]] CameraModel camera() const;

  bool operator==(const Lens&) const = default;
};

}  // namespace rds::geometry
