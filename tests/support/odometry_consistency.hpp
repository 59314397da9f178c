// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/geometry/trajectory.hpp"
#include "services/tracker/core/tracking_types.hpp"
#include "services/tracker/odometry/odometry.hpp"

namespace rds::test {

/// What one frame's odometry is off by, and what it tells of that.
struct OdometryError {
  double nees = 0;              // of the pose: eᵀ P⁻¹ e, six degrees of freedom
  double nees_translation = 0;  // of its parts, three each
  double nees_rotation = 0;
  double position_m = 0, rotation_rad = 0;              // |e|
  double told_position_m = 0, told_rotation_rad = 0;    // root of the trace of P's parts
  std::optional<double> speed_m_per_s, turn_rad_per_s;  // |error of the twist|; none without truth around
  std::optional<double> twist_nees;
};

/// Compares odometry, as it is told of a camera without a robot, with the truth. The truth is put where the
/// first frame's pose is, which map and odom are defined by.
class OdometryConsistency {
 public:
  /// @param truth  of the camera, by ascending time.
  explicit OdometryConsistency(std::span<const geometry::StampedPose> truth) : truth_(truth) {}

  /// The next frame's result; one without a pose is passed over.
  void add(std::int64_t stamp_ns, const tracker::FrameResult& result);
  [[nodiscard]] const std::vector<OdometryError>& errors() const { return errors_; }

 private:
  std::span<const geometry::StampedPose> truth_;
  tracker::Odometry odometry_;
  std::optional<geometry::Pose> odom_from_world_;
  std::vector<OdometryError> errors_;
};

/// Median, mean and such of one part of the errors.
double mean_of(std::span<const OdometryError> errors, double OdometryError::*part);
double median_of(std::span<const OdometryError> errors, std::optional<double> OdometryError::*part);

}  // namespace rds::test
