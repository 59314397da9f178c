// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/geometry/pose.hpp"
#include "common/topics/endpoints.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "tf2_msgs/msg/TFMessage.h"

namespace rds::tracker {

/// Publishes the camera's pose as odometry and transforms: odom→camera is continuous, map→odom takes the
/// jumps of the map (REP 105).
class OdometryOutput {
 public:
  explicit OdometryOutput(bus::Participant& bus);

  void publish(std::int64_t stamp_ns, const geometry::Pose& map_from_camera);
  /// The map moved under the camera: the next map→odom takes the jump.
  void move_map(const geometry::Pose& corrected_map_from_map) {
    map_from_odom_ = corrected_map_from_map * map_from_odom_;
  }
  /// Another map begins.
  void reset() { map_from_odom_ = geometry::Pose::Identity(); }

 private:
  geometry::Pose map_from_odom_ = geometry::Pose::Identity();
  bus::Publisher<nav_msgs::msg::Odometry> odometry_;
  bus::Publisher<tf2_msgs::msg::TFMessage> tf_;
};

}  // namespace rds::tracker
