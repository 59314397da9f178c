// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "common/image/rgbd_frame.hpp"
#include "services/tracker/core/map/local_map.hpp"
#include "services/tracker/core/motion/motion_model.hpp"
#include "services/tracker/core/pose/depth_aligner.hpp"
#include "services/tracker/core/pose/point_following.hpp"

namespace rds::tracker {

/// Microseconds since any moment; only for the times in results.
using Stopwatch = std::function<std::int64_t()>;

/// Settings that all ways of finding a pose share.
struct PoseSettings {
  ScalePyramid pyramid{1, 1};
  DepthConfig depth;
};

/// Where odometry has carried the camera on to since vision was sure of it.
struct CarriedPose {
  Pose map_from_camera = Pose::Identity();
  Matrix6 covariance = Matrix6::Zero();  // of a motion of the camera in its own frame
};

/// What is known of a picture when its pose is looked for. Lives as long as the picture is tracked.
struct TrackingContext {
  SlamMap& map;
  const PoseSettings& settings;
  const image::RgbdFrame& picture;  // its camera as calibrated
  ObservationModel model;           // of that camera
  MotionPrediction motion;
  TrackedFrame frame;                            // what all estimates start from
  std::optional<Pose> guess = std::nullopt;      // camera_from_map, by the last frame's points or by motion
  std::optional<Pose> alignment = std::nullopt;  // by the last frame's points, if its innovation is too large
  DepthView depth = {};                          // of the picture
  LocalMap local = {};                           // the last frame's points, and those around it
  MovableMask movable = {};
  std::optional<CarriedPose> carried = std::nullopt;
  std::optional<PointSearch> search = std::nullopt;  // for the local map's points, where they can be followed
};

/// How well a pose is supported: static matches, divided by an innovation that no hand would cause.
inline double support(const TrackedFrame& frame, const MotionPrediction& motion) {
  return frame.static_matches() / std::max(1.0, motion.innovation(frame.camera_from_map));
}

/// The features with what camera model, depth picture and rolling shutter say of them.
std::shared_ptr<const FeatureSet> complete_feature_set(const TrackingContext& context,
                                                       std::vector<Feature>&& features);

/// Pose from the frame's matches, as optimize_frame(). @return number of inliers.
int optimize(const TrackingContext& context, TrackedFrame& frame);

/// Counts in the map's points that the frame found them.
void count_found_points(SlamMap& map, const TrackedFrame& frame);

}  // namespace rds::tracker
