// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/geometry/keyframe_pose.hpp"
#include "common/geometry/loop_match.hpp"
#include "common/geometry/pose.hpp"

namespace rds::loop_closer {

using geometry::KeyframePose;
using geometry::LoopMatch;

/// Another keyframe as the tracker knew it at the moment of a keyframe.
struct Covisible {
  std::uint64_t id = 0;
  std::uint32_t weight = 0;  // shared map points; 0: it is told because it has moved
  geometry::Pose map_from_camera = geometry::Pose::Identity();
};

/// What the tracker says about a new keyframe. Element (row) i of each array is feature i.
struct KeyframeFeatures {
  std::uint64_t map_epoch = 0;
  std::uint64_t id = 0;
  std::int64_t stamp_ns = 0;
  geometry::Pose map_from_camera = geometry::Pose::Identity();
  bool follows = false;                 // the poses here contain the last correction
  cv::Mat descriptors;                  // N×32 CV_8U
  std::vector<Eigen::Vector3f> points;  // N, camera frame [m]; NaN without depth
  std::vector<std::uint8_t> movable;    // N, 1 on a movable object; empty: none is
  std::vector<Covisible> covisible;     // poses of the same moment as map_from_camera
};

/// The answer to one keyframe.
struct LoopAnswer {
  std::uint64_t map_epoch = 0;
  std::uint64_t keyframe_id = 0;
  std::uint64_t revision = 0;       // corrections so far
  std::uint32_t loops_closed = 0;   // as revision: one correction per loop
  std::vector<KeyframePose> poses;  // all keyframes, by id; empty unless this keyframe closed a loop
  std::vector<LoopMatch> loops;     // what was measured then
  std::string refused;              // why the keyframe was dropped; empty if it was taken
};

}  // namespace rds::loop_closer
