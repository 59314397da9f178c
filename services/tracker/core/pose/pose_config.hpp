// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rds::tracker {

/// Depth measurements. Their disparity fx·virtual_baseline_m / depth is what is compared with the map.
struct DepthConfig {
  double max_depth_m = 8.0;            // beyond: as if not measured
  double close_depth_m = 3.2;          // points nearer than this are made into map points at once
  double virtual_baseline_m = 0.0775;  // of the virtual stereo pair; Kinect's true one is about this
  double disparity_sigma_px = 0.6;     // of one depth measurement, whatever the pyramid level
  bool operator==(const DepthConfig&) const = default;
};

/// Motion-only optimisation of the camera pose.
struct PoseOptimizationConfig {
  int rounds = 4;          // each ends with a new classification into inliers and outliers
  int iterations = 10;     // per round, at most
  double chi2_2d = 5.991;  // 95 % for a pixel
  double chi2_3d = 7.815;  // 95 % for a pixel with disparity
  bool operator==(const PoseOptimizationConfig&) const = default;
};

/// Following map points from picture to picture by how they look.
struct FollowingConfig {
  bool enabled = true;            // false: features are extracted and matched in every frame
  int points = 400;               // followed
  int min_points = 50;            // that must agree on a pose; with fewer, features are extracted and matched
  double min_inlier_share = 0.5;  // of the followed points, that must agree
  double min_correlation = 0.8;   // of a point's patches
  double max_shift_px = 3;        // between expected and found place, in pixels of the patch
  int coarsest_level = 4;         // of the halvings of the picture, where its motion is looked for first
  int finest_level = 2;           // … and last; points are then found one by one
  int iterations = 10;            // per level, at most
  bool operator==(const FollowingConfig&) const = default;
};

/// Data association.
struct MatchingConfig {
  int max_distance_frame = 100;   // bits, frame to frame and local map
  int max_distance_strict = 50;   // bits, by appearance only and for fusion
  double ratio = 0.8;             // best to second best of one level
  double motion_window_px = 15;   // around where the motion model expects a feature, at level 0
  double map_window_factor = 3;   // of the local map's window (2.5 px in line of sight, else 4 px)
  double lost_window_factor = 6;  // the same after a weak prediction
  bool operator==(const MatchingConfig&) const = default;
};

}  // namespace rds::tracker
