// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "common/geometry/camera_model.hpp"
#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/features/feature.hpp"
#include "services/tracker/core/features/scale_pyramid.hpp"

namespace rds::tracker {

/// 95 % of χ² with two and with three degrees of freedom: bounds of a squared residual, and squared bounds of
/// Huber's loss, without and with depth.
inline constexpr double kChi2Pixel = 5.991;
inline constexpr double kChi2PixelAndDisparity = 7.815;
/// Points nearer to a camera, or behind it, say nothing about its pose [m].
inline constexpr double kMinDepth = 0.05;
/// Standard deviation of a measured disparity [px]. Corners lie at rims, where depth is of either side, and it
/// lies beside colour by about a pixel. The sensor's own part, f·b·σ_z / z², is less for every camera beyond
/// .3 m (docs/decisions/depth-noise.md).
inline constexpr double kDisparitySigmaPx = 0.6;

/// What a feature says about the point it sees, in units of its standard deviation once weighted.
struct Measurement {
  Eigen::Vector2d px = Eigen::Vector2d::Zero();  // undistorted
  double disparity_px = 0;                       // fx·baseline / depth; 0 without depth
  double px_weight = 1;                          // 1/σ
  double disparity_weight = 0;                   // 1/σ; 0 without depth
};

/// The virtual stereo camera of an RGB-D camera: a point (x, y, z) shows at a pixel with a disparity fx·b /
/// z.
///
/// Comparing disparities instead of depths gives depth noise that grows with z² a constant size.
/// Source: Mur-Artal & Tardós 2017, §III-A. Deviation: the disparity has a standard deviation of its own,
/// for a depth sensor measures much better than a matched stereo pair.
class ObservationModel {
 public:
  static constexpr double kBaselineM = 0.0775;  // b; between the two cameras of a Kinect it is about this

  explicit ObservationModel(const geometry::CameraModel& camera)
      : fx_(camera.fx),
        fy_(camera.fy),
        cx_(camera.cx),
        cy_(camera.cy),
        fx_baseline_(camera.fx * kBaselineM) {}

  [[nodiscard]] double disparity(double depth_m) const { return fx_baseline_ / depth_m; }

  [[nodiscard]] Measurement measurement(const Feature& feature, const ScalePyramid& pyramid) const {
    Measurement m;
    m.px = feature.px.cast<double>();
    m.px_weight = 1 / pyramid.scale(feature.level);
    if (feature.depth_m > 0) {
      m.disparity_px = disparity(static_cast<double>(feature.depth_m));
      m.disparity_weight = 1 / kDisparitySigmaPx;
    }
    return m;
  }

  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p) const {
    return {fx_ * p.x() / p.z() + cx_, fy_ * p.y() / p.z() + cy_};
  }

  /// Ray (x, y, 1) of an undistorted pixel.
  [[nodiscard]] Eigen::Vector3d ray(const Eigen::Vector2d& px) const {
    return {(px.x() - cx_) / fx_, (px.y() - cy_) / fy_, 1};
  }

  /// Distance [px] of a ray (x, y, 1) from the line in which a plane through the camera shows.
  [[nodiscard]] double distance_px(const Eigen::Vector3d& plane_normal, const Eigen::Vector3d& ray) const {
    return std::abs(plane_normal.dot(ray)) / std::hypot(plane_normal.x() / fx_, plane_normal.y() / fy_);
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
  [[nodiscard]] static double chi2(const Measurement& m) {
    return m.disparity_weight > 0 ? kChi2PixelAndDisparity : kChi2Pixel;
  }

 private:
  double fx_, fy_, cx_, cy_;
  double fx_baseline_;
};

}  // namespace rds::tracker
