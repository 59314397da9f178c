// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "services/tracker/core/features/image_pyramid.hpp"
#include "services/tracker/core/map/slam_map.hpp"
#include "services/tracker/core/motion/rolling_shutter.hpp"

namespace rds::tracker {

/// With fewer inliers a pose is weak, and its frame no keyframe.
inline constexpr int kMinInliers = 30;
/// With fewer inliers a pose may be wrong, and another way to it may find more.
inline constexpr int kSureInliers = 80;

/// A frame while it is tracked.
struct TrackedFrame {
  std::int64_t stamp_ns = 0;
  std::int64_t time_ns = 0;                    // of the tracker's ContinuousTime
  std::shared_ptr<const ImagePyramid> images;  // of the picture
  std::shared_ptr<const FeatureSet> features;
  std::vector<PointId> points;  // per feature: the map point it sees; kNoId
  Pose camera_from_map = Pose::Identity();
  Eigen::Matrix<double, 6, 6> information =
      Eigen::Matrix<double, 6, 6>::Zero();  // OptimizedPose::information
  ShutterMotion motion;                     // that px and depth of the features are compensated for
  double given_fx = 0;                      // px, of the camera before calibration; 0: it is not calibrated
  bool pose_is_given = false;               // and not to be estimated
  bool movable_in_view = false;             // something that can move: points that are new may be its
  bool by_depth_only = false;               // the pose comes from depth alone
  double found_share = 1;                   // of the expected map points, relative to the usual (FoundShare)

  [[nodiscard]] int matches() const {
    return static_cast<int>(std::ranges::count_if(points, [](PointId p) { return p != kNoId; }));
  }
  /// Matches of features that are not on movable objects; only these may carry a keyframe.
  [[nodiscard]] int static_matches() const {
    int matches = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      matches += points[i] != kNoId && !(*features)[i].movable ? 1 : 0;
    return matches;
  }
  void clear_matches() { points.assign(features->size(), kNoId); }
};

/// The last frame whose pose rests on map points.
struct LastFrame {
  TrackedFrame frame;
  KeyframeId reference = kNoId;
  Pose reference_from_camera = Pose::Identity();
};

}  // namespace rds::tracker
