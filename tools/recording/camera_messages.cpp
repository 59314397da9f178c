// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/camera_messages.hpp"

#include "common/messages/conversions.hpp"
#include "common/messages/sensors/imu_conversions.hpp"
#include "common/messages/image_conversions.hpp"

namespace rds::recording {
namespace {

constexpr const char* kOpticalFrame = "camera_color_optical_frame";
constexpr const char* kBaseFrame = "base_link";
constexpr const char* kImuFrame = "imu_link";
constexpr double kSamePlace = 1e-9;

std_msgs::msg::Header header_at(std::int64_t stamp_ns) {
  return messages::make_header(stamp_ns, kOpticalFrame);
}

/// The frame's own name, unless it is the camera's.
const char* frame_of(const geometry::Pose& to_camera, const char* name) {
  return to_camera.isApprox(geometry::Pose::Identity(), kSamePlace) ? kOpticalFrame : name;
}

geometry_msgs::msg::TransformStamped transform(const char* parent, const char* child,
                                               const geometry::Pose& parent_from_child) {
  geometry_msgs::msg::TransformStamped message;
  message.header(messages::make_header(0, parent));
  message.child_frame_id(child);
  message.transform(messages::to_transform_message(parent_from_child));
  return message;
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

sensor_msgs::msg::Imu imu_message(const image::ImuTrack& of, const image::ImuMeasurement& measurement,
                                  std::int64_t stamp_ns) {
  return messages::to_imu_message(
      measurement, of.has_gyroscope,
      messages::make_header(stamp_ns, frame_of(of.camera_from_imu, kImuFrame)));
}

nav_msgs::msg::Odometry odometry_message(const image::OdometryTrack& of, const geometry::Pose& odom_from_body,
                                         std::int64_t stamp_ns) {
  nav_msgs::msg::Odometry message;
  message.header(messages::make_header(stamp_ns, "odom"));
  message.child_frame_id(frame_of(of.body_from_camera, kBaseFrame));
  message.pose().pose(messages::to_pose_message(odom_from_body));
  return message;
}

std::optional<tf2_msgs::msg::TFMessage> mounting_message(const image::RobotSensors& sensors) {
  tf2_msgs::msg::TFMessage tree;
  const auto is_apart = [](const geometry::Pose& pose) { return frame_of(pose, "") != kOpticalFrame; };
  if (sensors.odometry && is_apart(sensors.odometry->body_from_camera))
    tree.transforms().push_back(transform(kBaseFrame, kOpticalFrame, sensors.odometry->body_from_camera));
  if (sensors.imu && is_apart(sensors.imu->camera_from_imu))
    tree.transforms().push_back(transform(kOpticalFrame, kImuFrame, sensors.imu->camera_from_imu));
  if (tree.transforms().empty()) return std::nullopt;
  return tree;
}

}  // namespace rds::recording
