// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "common/geometry/transforms/transform_tree.hpp"

namespace rds::tracker {

/// Names of frames, with the robot's prefix.
struct FrameNames {
  std::string map;
  std::string odom;
  std::string base;  // where it is in the tree of the camera
};

/// How the camera stands in the tree of frames at one time, and who publishes what. A frame has one parent
/// (REP 105), so ours to publish is map → odom and odom → the root of the camera's tree, as far as nobody
/// else does.
struct RobotFrames {
  std::string body;   // child of odom: the root of the camera's tree, or what another node hangs below odom
  std::string child;  // that odometry tells of: the base, or else the body
  geometry::Pose body_from_camera = geometry::Pose::Identity();
  geometry::Pose child_from_camera = geometry::Pose::Identity();
  bool map_to_odom_is_ours = true;
  bool odom_to_body_is_ours = true;
  std::optional<geometry::Pose> odom_from_camera = {};  // where another node publishes odom → the robot
};

/// @param camera  frame_id of the pictures.
RobotFrames robot_frames(const geometry::TransformTree& tree, const FrameNames& names,
                         const std::string& camera, std::int64_t stamp_ns);

}  // namespace rds::tracker
