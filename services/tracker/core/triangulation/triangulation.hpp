// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/geometry/pose.hpp"
#include "services/tracker/core/pose/observation_model.hpp"

namespace rds::tracker {

/// 95 % of a normal distribution lie within so many standard deviations.
inline constexpr double kSigmas95 = 1.96;

/// A feature that may see a point, and the camera that it is of.
struct PointView {
  geometry::Pose camera_from_map = geometry::Pose::Identity();
  ObservationModel model;
  Measurement measurement;
};

struct TriangulatedPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      // m, map
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();    // m², if the poses are exact
};

/// The point p with the least sum of squared residuals r_i over all views, and its covariance:
///
///     argmin_p Σ_i ‖r_i(T_i p)‖²,   Σ_p = ( Σ_i J_iᵀ J_i )⁻¹,   J_i = ∂r_i / ∂p
///
/// It begins where the rays of the features pass nearest to each other. A feature with depth counts with it.
/// @return nullopt if the rays are parallel, or the point is behind one of the cameras.
/// Source: Hartley & Zisserman 2004, §12.3 (by iteration), §5.2.4 (covariance).
std::optional<TriangulatedPoint> triangulate(std::span<const PointView> views);

/// The covariance of a point at a position; not finite where the views do not determine it.
Eigen::Matrix3d covariance_at(std::span<const PointView> views, const Eigen::Vector3d& position);

/// Whether the disparity that the view's camera should measure is known as well as a depth sensor would tell
/// it, and that the point is not infinitely far away by three standard deviations:
///
///     f b σ_z / z² ≤ 0.6 px,   σ_z ≤ z / 3
bool is_known_well(const TriangulatedPoint& point, const PointView& view);

/// The squared residual is within its 95 % bound, and the point before the camera.
bool agrees(const PointView& view, const Eigen::Vector3d& point_in_map);

/// Standard deviation of the point's depth in a camera [m].
double depth_sigma_m(const TriangulatedPoint& point, const geometry::Pose& camera_from_map);

/// Standard deviation of the pixel at which a camera should see the point, in the worse direction; the point
/// lies before it.
double pixel_sigma_px(const TriangulatedPoint& point, const geometry::Pose& camera_from_map,
                      const ObservationModel& model);

}  // namespace rds::tracker
