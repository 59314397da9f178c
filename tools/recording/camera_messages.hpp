// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/geometry/pose.hpp"
#include "common/image/rgbd_frame.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "sensor_msgs/msg/CameraInfo.h"
#include "sensor_msgs/msg/Image.h"

/// What a camera publishes of a recording's pictures, in the camera's optical frame.
namespace rds::recording {

sensor_msgs::msg::Image color_message(const image::ColorImage& color, std::int64_t stamp_ns);
sensor_msgs::msg::Image depth_message(const image::DepthImage& depth, std::int64_t stamp_ns);
sensor_msgs::msg::CameraInfo camera_info_message(const geometry::CameraModel& camera, std::int64_t stamp_ns);
/// Odometry of the camera; covariances and speed, which are not known, are zero.
nav_msgs::msg::Odometry odometry_message(const geometry::Pose& odom_from_camera, std::int64_t stamp_ns);

}  // namespace rds::recording
