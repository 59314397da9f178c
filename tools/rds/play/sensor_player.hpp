// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/bus/participant.hpp"
#include "common/image/sensors/robot_sensors.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/Imu.h"
#include "tf2_msgs/msg/TFMessage.h"

namespace rds::play {

/// Publishes what a robot has sensed, as it would: an IMU on imu, odometry on odom, on tf_static how both
/// stand to the camera.
class SensorPlayer {
 public:
  /// @param bus  how the sensors stand is published at once, the rest by publish_through().
  SensorPlayer(bus::Participant& bus, image::RobotSensors sensors);

  /// Of each sensor what was not published yet, up to the first measurement that is not before this stamp of
  /// the recording: so every time until then can be interpolated. Of those far before it, as many as an
  /// accelerometer needs to see that it stands still.
  /// @param shift_ns  that stamps are told later by. Where it grows the recording begins again.
  void publish_through(std::int64_t stamp_ns, std::int64_t shift_ns);

 private:
  image::RobotSensors sensors_;
  std::size_t next_odometry_ = 0;
  std::size_t next_imu_ = 0;
  std::int64_t shift_ns_ = 0;
  bus::Publisher<tf2_msgs::msg::TFMessage> mounting_;  // those that are used
  bus::Publisher<nav_msgs::msg::Odometry> odometry_;
  bus::Publisher<sensor_msgs::msg::Imu> imu_;
};

}  // namespace rds::play
