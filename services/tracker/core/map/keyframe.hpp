// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/geometry/keyframe_pose.hpp"
#include "common/geometry/pose.hpp"
#include "services/tracker/core/features/feature_set.hpp"
#include "services/tracker/core/features/image_pyramid.hpp"
#include "services/tracker/core/map/map_point.hpp"
#include "services/tracker/core/motion/rolling_shutter.hpp"

namespace rds::tracker {

using geometry::KeyframePose;
using geometry::Pose;

struct CovisibleKeyframe {
  KeyframeId id = kNoId;
  int weight = 0;  // shared map points
};

struct Keyframe {
  KeyframeId id = kNoId;
  std::int64_t stamp_ns = 0;
  std::int64_t time_ns = 0;  // of the tracker's ContinuousTime; by default the stamp
  Pose map_from_camera = Pose::Identity();
  ShutterMotion motion;        // that px and depth of the features are compensated for
  double given_fx = 0;         // px, of the camera before calibration; 0: it is not calibrated
  bool pose_is_given = false;  // and fixed in bundle adjustment
  std::shared_ptr<const FeatureSet> features;
  std::shared_ptr<const ImagePyramid> images;  // null if points are not followed, and in a map that was saved
  std::vector<PointId> points;                 // per feature; kNoId
  std::vector<bool> movable;                   // per feature; more than the set knows after late boxes
  std::vector<CovisibleKeyframe> covisible;    // most shared points first, then by id
  int tracked_points = 0;                      // map points that its frame saw when it became a keyframe
};

}  // namespace rds::tracker
