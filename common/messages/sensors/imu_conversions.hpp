// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/sensors/robot_sensors.hpp"
#include "sensor_msgs/msg/Imu.h"

namespace rds::messages {

/// As it was told, with whatever is not finite.
image::ImuMeasurement to_measurement(const sensor_msgs::msg::Imu& message);

/// False for a unit that measures acceleration alone: it says so in the first number of the covariance.
bool has_gyroscope(const sensor_msgs::msg::Imu& message);

/// Without an orientation, which is not measured.
/// @param header  with the stamp that is told.
sensor_msgs::msg::Imu to_imu_message(const image::ImuMeasurement& measurement, bool has_gyroscope,
                                     std_msgs::msg::Header header);

}  // namespace rds::messages
