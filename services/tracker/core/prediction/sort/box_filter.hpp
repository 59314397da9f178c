// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "common/geometry/box.hpp"

namespace rds::tracker::prediction {

/// Constant-velocity Kalman filter of one box in a plane.
///
/// State [u, v, s, r, u̇, v̇, ṡ]: centre, area, aspect (width / height, constant) and their rates per frame.
/// Lengths are in pixels or any unit in which boxes measure tens to hundreds.
/// Source: Bewley et al. 2016 (SORT), eqs. 1 and following, with its published noise. Deviation: the real
/// time step stands in F and Q (Q·Δt), so that frames may be unevenly spaced; Δt = 1 is the original.
class BoxFilter {
 public:
  /// @param box  with an area > 0.
  explicit BoxFilter(const geometry::Box2& box);

  /// Moves the state by `frames` (> 0) frame periods.
  void predict(double frames);
  void correct(const geometry::Box2& box);

  [[nodiscard]] geometry::Box2 box() const;
  [[nodiscard]] Eigen::Vector2d velocity() const { return state_.segment<2>(4); }  // per frame
  [[nodiscard]] Eigen::Vector2d center_variance() const { return covariance_.diagonal().head<2>(); }
  [[nodiscard]] bool is_finite() const { return state_.allFinite() && state_(2) > 0 && state_(3) > 0; }

 private:
  Eigen::Matrix<double, 7, 1> state_ = Eigen::Matrix<double, 7, 1>::Zero();
  Eigen::Matrix<double, 7, 7> covariance_;
};

}  // namespace rds::tracker::prediction
