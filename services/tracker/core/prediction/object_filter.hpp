// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "common/geometry/oriented_box.hpp"
#include "services/tracker/core/prediction/tracked_object.hpp"

namespace rds::tracker::prediction {

/// Constant-velocity Kalman filter of one object in the map; its width, height and thickness wander slowly.
///
/// State [p; v] in the map with white acceleration noise. A detection measures p, well across its viewing
/// direction and worse along it: R = map_from_box · diag(σ_lateral², σ_lateral², σ_depth²) · map_from_boxᵀ.
/// Each edge length has a scalar random-walk filter of its own. The orientation is the latest detection's.
class ObjectFilter {
 public:
  /// An object that the picture's side cuts off is at least this wide [m].
  static constexpr double kMinWidthM = 0.5;

  ObjectFilter(const geometry::OrientedBox& box, const CutSides& cut);

  /// Moves the state forward. @param seconds  ≥ 0.
  void predict(double seconds);
  void correct(const geometry::OrientedBox& box, const CutSides& cut);
  /// Distance of a detection's centre in standard deviations; what the picture's edge cuts off counts as
  /// unknown.
  [[nodiscard]] double mahalanobis(const geometry::OrientedBox& box, const CutSides& cut) const;

  /// Changes the map's coordinates: new_from_old * point_in_old_map = point_in_map.
  void move_map(const geometry::Pose& new_from_old);

  [[nodiscard]] geometry::OrientedBox box() const;
  [[nodiscard]] Eigen::Vector3d center() const { return state_.head<3>(); }
  [[nodiscard]] Eigen::Vector3d velocity() const { return state_.tail<3>(); }
  [[nodiscard]] Eigen::Matrix3d center_covariance() const { return covariance_.topLeftCorner<3, 3>(); }
  /// Standard deviation of the centre along each axis of the box [m].
  [[nodiscard]] Eigen::Vector3d center_sigma_in_box() const;

 private:
  struct Innovation;
  [[nodiscard]] Innovation compare(const geometry::OrientedBox& box, const CutSides& cut) const;

  Eigen::Matrix<double, 6, 1> state_ = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> covariance_ = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector3d size_;
  Eigen::Vector3d size_variance_;
  Eigen::Matrix3d map_from_box_;
};

}  // namespace rds::tracker::prediction
