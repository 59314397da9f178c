// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/odometry_output.hpp"

#include "common/messages/conversions.hpp"

namespace rds::tracker {
namespace {

const std::string kMap = "map";
const std::string kOdom = "odom";
const std::string kCamera = "camera_color_optical_frame";

geometry_msgs::msg::TransformStamped transform(std::int64_t stamp_ns, const std::string& parent,
                                               const std::string& child,
                                               const geometry::Pose& parent_from_child) {
  geometry_msgs::msg::TransformStamped message;
  message.header(messages::make_header(stamp_ns, parent));
  message.child_frame_id(child);
  message.transform(messages::to_transform_message(parent_from_child));
  return message;
}

}  // namespace

OdometryOutput::OdometryOutput(bus::Participant& bus)
    : odometry_(topics::advertise(bus, topics::kOdometry, topics::kTracker)),
      tf_(topics::advertise(bus, topics::kTransforms, topics::kTracker)) {}

void OdometryOutput::publish(std::int64_t stamp_ns, const geometry::Pose& map_from_camera) {
  const geometry::Pose odom_from_camera = map_from_odom_.inverse() * map_from_camera;
  nav_msgs::msg::Odometry odometry;
  odometry.header(messages::make_header(stamp_ns, kOdom));
  odometry.child_frame_id(kCamera);
  odometry.pose().pose(messages::to_pose_message(odom_from_camera));
  odometry_.write(odometry);
  tf2_msgs::msg::TFMessage tf;
  tf.transforms().push_back(transform(stamp_ns, kMap, kOdom, map_from_odom_));
  tf.transforms().push_back(transform(stamp_ns, kOdom, kCamera, odom_from_camera));
  tf_.write(tf);
}

}  // namespace rds::tracker
