// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/geometry/pose.hpp"
#include "services/tracker/core/pose/observation_model.hpp"

namespace rds::tracker {

/// A map point and the feature that is believed to see it.
struct PointObservation {
  Eigen::Vector3d point_in_map = Eigen::Vector3d::Zero();
  Measurement measurement;
  double weight = 1;  // static_weight() of the point
};

struct OptimizedPose {
  geometry::Pose camera_from_map = geometry::Pose::Identity();
  std::vector<bool> inlier;  // per observation
  int inliers = 0;
  /// About a motion of the map in the camera's frame; of a camera that stood still its inverse is the
  /// covariance. Zero if it was not optimised.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Moves the camera so that map points show where their features are (motion-only bundle adjustment).
///
/// Levenberg–Marquardt on SE(3) with analytic Jacobians and Huber's loss; after each round observations
/// beyond the χ² bound are set aside, and may come back after the next. The last half of the rounds goes
/// without Huber's loss. Fewer than three observations leave the pose as it is, with no inliers. Source:
/// Mur-Artal & Tardós 2017, §III-C.
OptimizedPose optimize_pose(const ObservationModel& model, std::span<const PointObservation> observations,
                            const geometry::Pose& camera_from_map);

/// Covariance of a motion of the camera in its own frame, of OptimizedPose::information. A pose without
/// information is one by depth alone, which may be off by as much as the tracker lets pass (.1 m, .1 rad).
Eigen::Matrix<double, 6, 6> pose_covariance(const Eigen::Matrix<double, 6, 6>& information);

/// Which observations agree with a pose (χ² bound); the pose stays.
OptimizedPose check_pose(const ObservationModel& model, std::span<const PointObservation> observations,
                         const geometry::Pose& camera_from_map);

}  // namespace rds::tracker
