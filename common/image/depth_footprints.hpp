// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/pose.hpp"

namespace rds::image {

/// Where the measurements of one row of a depth picture are in the picture of another camera, each as wide as
/// its pixel is there, times kWider. Keeps its buffers from row to row.
class DepthFootprints {
 public:
  /// So that the gaps close that open between neighbours on a slope: b tan(slope) / z of a width, of cameras
  /// b apart, which is ¼ of 5 cm at 1 m and 79°.
  static constexpr float kWider = 1.25F;
  static constexpr float kWidestPx = 8;      // half of a width at most
  static constexpr float kNearestM = 0.05F;  // from the target; what is nearer is not drawn

  using Floats = Eigen::Array<float, 1, Eigen::Dynamic>;
  using Ints = Eigen::Array<int, 1, Eigen::Dynamic>;

  /// Rays (x, y, 1) of the row's pixels, and half of the distance to the next ray; 0 where the lens has none.
  struct Rays {
    Eigen::Map<const Floats> x, y, half;
  };
  /// Pixels of one axis, inside the picture: from first to before end.
  struct Span {
    Ints first, end;
  };

  /// @param target  outlives this.
  DepthFootprints(const geometry::CameraModel& target, const geometry::Pose& target_from_source);

  /// @param metres  along the source's optical axis, finite; 0 where nothing is measured.
  void place(const Floats& metres, const Rays& rays);

  /// In the target's frame [m]; less than kNearestM where there is nothing to draw.
  [[nodiscard]] const Floats& z() const { return z_; }
  [[nodiscard]] const Span& columns() const { return columns_; }
  [[nodiscard]] const Span& rows() const { return rows_; }

 private:
  void bend();
  void cover(Floats& at, double focal, double center, int size, Span& span);

  const geometry::CameraModel& target_;
  Eigen::Matrix3f turn_;
  Eigen::Vector3f shift_;
  float spread_;       // of a square that is turned, along the axes
  float widest_ray2_;  // x² + y² of the target's rays: beyond, its distortion says nothing
  Floats z_, per_z_, x_, y_, reach_, reach_px_;
  Span columns_, rows_;
};

}  // namespace rds::image
