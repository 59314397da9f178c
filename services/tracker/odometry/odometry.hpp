// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/odometry/robot_frames.hpp"

namespace rds::tracker {

using Matrix6 = Eigen::Matrix<double, 6, 6>;  // of translation, then rotation, as Twist

/// A frame's pose, as the tracker found it.
struct TrackedPose {
  std::int64_t stamp_ns = 0;
  geometry::Pose map_from_camera = geometry::Pose::Identity();
  Matrix6 information = Matrix6::Zero();  // of a motion in the camera's frame; zero: not known
  bool is_continuous = true;              // false after a relocalisation: the pose may have jumped
  bool is_placed = true;                  // false: it is in a submap, whose place in the map is not known
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
/// takes the corrections of loops and the jumps of relocalisations (REP 105). The robot's speed is that over
/// the last kWindowNs.
class Odometry {
 public:
  static constexpr std::int64_t kWindowNs = 150'000'000;  // noise of 2 mm at both ends is .02 m/s

  OdometryStep step(const TrackedPose& pose, const RobotFrames& frames);
  /// The map moved under the camera: the next map → odom takes the jump.
  void move_map(const geometry::Pose& corrected_map_from_map) {
    map_from_odom_ = corrected_map_from_map * map_from_odom_;
  }
  /// Another map begins: the robot stays where it is in odom.
  void begin_map() { joins_ = true; }

 private:
  struct Past {
    std::int64_t stamp_ns;
    geometry::Pose odom_from_child;
    Matrix6 covariance;  // in the child's frame
  };
  void tell_speed(const Past& now, OdometryStep& step);

  geometry::Pose map_from_odom_ = geometry::Pose::Identity();
  geometry::Pose odom_from_camera_ = geometry::Pose::Identity();  // of the last frame
  bool joins_ = false;
  std::string child_;
  std::deque<Past> past_;
};

/// Covariance of a motion in the frame of `child`, which is fixed to the camera, of the information about the
/// same motion in the camera's frame. Directions without information have kUnknownM and kUnknownRad; nothing
/// is ever certain.
Matrix6 covariance_of(const Matrix6& information, const geometry::Pose& child_from_camera);

}  // namespace rds::tracker
