// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

/// A feature of a keyframe as other services see it.
struct KeyframeFeature {
  Feature feature;
  Eigen::Vector3f point_in_camera = Eigen::Vector3f::Zero();  // m; NaN without depth
  std::int64_t map_point_id = -1;                             // -1 where it sees none
};

struct CovisiblePose {
  std::uint64_t id = 0;
  int weight = 0;                           // shared map points
  Pose map_from_camera = Pose::Identity();  // at the moment of the keyframe
};

/// A new keyframe as other services see it.
struct KeyframeData {
  std::uint64_t id = 0;
  std::int64_t stamp_ns = 0;
  Pose map_from_camera = Pose::Identity();
  std::vector<KeyframeFeature> features;
  std::vector<CovisiblePose> covisible;  // most shared points first
  bool in_map = true;                    // false: it is for other services only
};

}  // namespace rds::tracker
