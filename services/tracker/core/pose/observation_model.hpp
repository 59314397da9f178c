// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "common/geometry/camera_model.hpp"
#include "services/tracker/core/features/feature.hpp"
#include "services/tracker/core/features/scale_pyramid.hpp"
#include "services/tracker/core/pose/pose_config.hpp"

namespace rds::tracker {

/// What a feature says about the point it sees, in units of its standard deviation once weighted.
struct Measurement {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();  // undistorted
  double disparity_px = 0;                       // fx·baseline / depth; 0 without depth
  double px_weight = 1;                          // 1/σ
  double disparity_weight = 0;                   // 1/σ; 0 without depth
};

/// The virtual stereo camera of an RGB-D camera: a point (x, y, z) shows at a pixel with a disparity.
///
/// Comparing disparities instead of depths gives depth noise that grows with z² a constant size.
/// Source: Mur-Artal & Tardós 2017, §III-A. Deviation: the disparity has a standard deviation of its own,
/// for a depth sensor measures much better than a matched stereo pair.
class ObservationModel {
 public:
  ObservationModel(const geometry::CameraModel& camera, const DepthConfig& depth)
      : fx_(camera.fx),
        fy_(camera.fy),
        cx_(camera.cx),
        cy_(camera.cy),
        fx_baseline_(camera.fx * depth.virtual_baseline_m),
        disparity_weight_(1 / depth.disparity_sigma_px) {}

  [[nodiscard]] double disparity(double depth_m) const { return fx_baseline_ / depth_m; }

  [[nodiscard]] Measurement measurement(const Feature& feature, const ScalePyramid& pyramid) const {
    Measurement m;
    m.px = feature.px.cast<double>();
    m.px_weight = 1 / pyramid.scale(feature.level);
    if (feature.depth_m > 0) {
      m.disparity_px = disparity(static_cast<double>(feature.depth_m));
      m.disparity_weight = disparity_weight_;
    }
    return m;
  }

  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p) const {
    return {fx_ * p.x() / p.z() + cx_, fy_ * p.y() / p.z() + cy_};
  }

  /// Weighted residual (predicted − measured) of a camera-frame point with z > 0.
  [[nodiscard]] Eigen::Vector3d residual(const Eigen::Vector3d& p, const Measurement& m) const {
    const Eigen::Vector2d px = project(p);
    return {m.px_weight * (px.x() - m.px.x()), m.px_weight * (px.y() - m.px.y()),
            m.disparity_weight * (disparity(p.z()) - m.disparity_px)};
  }

  /// Derivative of residual() by a factor on the focal length.
  [[nodiscard]] Eigen::Vector3d by_focal_scale(const Eigen::Vector3d& p, const Measurement& m) const {
    return {m.px_weight * fx_ * p.x() / p.z(), m.px_weight * fy_ * p.y() / p.z(), 0};
  }

  /// Derivative of residual() by the camera-frame point.
  [[nodiscard]] Eigen::Matrix3d jacobian(const Eigen::Vector3d& p, const Measurement& m) const {
    const double inverse_z = 1 / p.z();
    const double inverse_z2 = inverse_z * inverse_z;
    Eigen::Matrix3d j = Eigen::Matrix3d::Zero();
    j(0, 0) = m.px_weight * fx_ * inverse_z;
    j(0, 2) = -m.px_weight * fx_ * p.x() * inverse_z2;
    j(1, 1) = m.px_weight * fy_ * inverse_z;
    j(1, 2) = -m.px_weight * fy_ * p.y() * inverse_z2;
    j(2, 2) = -m.disparity_weight * fx_baseline_ * inverse_z2;
    return j;
  }

  /// 95 % bound of the squared residual.
  [[nodiscard]] static double chi2(const Measurement& m, const PoseOptimizationConfig& config) {
    return m.disparity_weight > 0 ? config.chi2_3d : config.chi2_2d;
  }

 private:
  double fx_, fy_, cx_, cy_;
  double fx_baseline_;
  double disparity_weight_;
};

}  // namespace rds::tracker
