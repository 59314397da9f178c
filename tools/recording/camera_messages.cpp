// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/camera_messages.hpp"

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"

namespace rds::recording {
namespace {

constexpr const char* kOpticalFrame = "camera_color_optical_frame";

std_msgs::msg::Header header_at(std::int64_t stamp_ns) {
  return messages::make_header(stamp_ns, kOpticalFrame);
}

}  // namespace

sensor_msgs::msg::Image color_message(const image::ColorImage& color, std::int64_t stamp_ns) {
  return messages::to_image_message(color, header_at(stamp_ns));
}

sensor_msgs::msg::Image depth_message(const image::DepthImage& depth, std::int64_t stamp_ns) {
  return messages::to_image_message(depth, header_at(stamp_ns));
}

sensor_msgs::msg::CameraInfo camera_info_message(const geometry::CameraModel& camera, std::int64_t stamp_ns) {
  return messages::to_camera_info(camera, header_at(stamp_ns));
}

nav_msgs::msg::Odometry odometry_message(const geometry::Pose& odom_from_camera, std::int64_t stamp_ns) {
  nav_msgs::msg::Odometry message;
  message.header(messages::make_header(stamp_ns, "odom"));
  message.child_frame_id(kOpticalFrame);
  message.pose().pose(messages::to_pose_message(odom_from_camera));
  return message;
}

}  // namespace rds::recording
