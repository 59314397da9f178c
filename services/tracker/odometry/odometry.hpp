// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/odometry/robot_frames.hpp"
#include "services/tracker/odometry/twist_filter.hpp"

namespace rds::tracker {

/// A frame's pose, as the tracker found it.
struct TrackedPose {
  std::int64_t stamp_ns = 0;
  geometry::Pose map_from_camera = geometry::Pose::Identity();
  Matrix6 information = Matrix6::Zero();     // of a motion in the camera's frame; zero: not known
  bool is_continuous = true;                 // false after a relocalisation: the pose may have jumped
  bool is_placed = true;                     // false: it is in a submap, whose place in the map is not known
  std::optional<Matrix6> covariance = {};    // of a pose that odometry carries on, in place of information
  Matrix6 map_covariance = Matrix6::Zero();  // of the map that it is found in, likewise of a motion
};

/// What there is to tell of one frame.
struct OdometryStep {
  std::optional<geometry::Pose>
      map_from_odom;  // to publish; nullopt where another node does, or it is not known
  std::optional<geometry::Pose> odom_from_body;  // likewise
  bool is_in_map = false;  // the pose is in map, as odom is another node's; else in odom
  geometry::Pose parent_from_child = geometry::Pose::Identity();
  Matrix6 pose_covariance = Matrix6::Zero();  // about the axes of the parent
  Twist twist = Twist::Zero();                // of the child, in its own frame [m/s, rad/s]
  Matrix6 twist_covariance = Matrix6::Zero();
};

/// Splits the camera's pose in the map into map → odom and odom → robot: odom → robot never jumps, map → odom
/// takes the corrections of loops and the jumps of relocalisations (REP 105). The robot's speed is told by a
/// filter on its poses.
class Odometry {
 public:
  OdometryStep step(const TrackedPose& pose, const RobotFrames& frames);
  /// The map moved under the camera: the next map → odom takes the jump.
  void move_map(const geometry::Pose& corrected_map_from_map) {
    map_from_odom_ = corrected_map_from_map * map_from_odom_;
  }
  /// Another map begins: the robot stays where it is in odom.
  void begin_map() { joins_ = true; }

 private:
  /// In odom, if the body has stayed where it was: the camera may have turned on it since the last frame.
  [[nodiscard]] geometry::Pose camera_on_body_at_rest(const RobotFrames& frames) const;

  geometry::Pose map_from_odom_ = geometry::Pose::Identity();
  geometry::Pose odom_from_camera_ = geometry::Pose::Identity();  // of the last frame
  std::string body_;                                               // likewise, …
  geometry::Pose body_from_camera_ = geometry::Pose::Identity();   // … and where the camera was on it
  bool joins_ = false;
  std::string child_;
  TwistFilter speed_;
};

/// Covariance of a motion in the frame of `child`, which is fixed to the camera, of that of the same motion
/// in the camera's frame.
Matrix6 covariance_in_child(const Matrix6& in_camera, const geometry::Pose& child_from_camera);

}  // namespace rds::tracker
