// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "common/geometry/pose.hpp"
#include "common/image/rgbd_frame.hpp"
#include "common/image/sensors/robot_sensors.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/CameraInfo.h"
#include "sensor_msgs/msg/Image.h"
#include "sensor_msgs/msg/Imu.h"
#include "tf2_msgs/msg/TFMessage.h"

/// What a robot publishes of a recording: the camera's pictures, in its optical frame, and what else it has
/// sensed.
namespace rds::recording {

sensor_msgs::msg::Image color_message(const image::ColorImage& color, std::int64_t stamp_ns);
sensor_msgs::msg::Image depth_message(const image::DepthImage& depth, std::int64_t stamp_ns);
sensor_msgs::msg::CameraInfo camera_info_message(const geometry::CameraModel& camera, std::int64_t stamp_ns);

/// In the unit's frame: imu_link, or the camera's where it stands in that.
sensor_msgs::msg::Imu imu_message(const image::ImuTrack& of, const image::ImuMeasurement& measurement,
                                  std::int64_t stamp_ns);
/// Of base_link, or of the camera where that is the body. Covariances and speed, which are not known, are
/// zero.
nav_msgs::msg::Odometry odometry_message(const image::OdometryTrack& of, const geometry::Pose& odom_from_body,
                                         std::int64_t stamp_ns);
/// How these frames stand to the camera's, for tf_static; nullopt if there are no others.
std::optional<tf2_msgs::msg::TFMessage> mounting_message(const image::RobotSensors& sensors);

}  // namespace rds::recording
