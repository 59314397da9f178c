// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/odometry/odometry_output.hpp"

#include <array>
#include <memory>

#include "common/messages/conversions.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::tracker {
namespace {

using Transforms = std::shared_ptr<const tf2_msgs::msg::TFMessage>;

geometry_msgs::msg::TransformStamped transform(std::int64_t stamp_ns, const std::string& parent,
                                               const std::string& child,
                                               const geometry::Pose& parent_from_child) {
  geometry_msgs::msg::TransformStamped message;
  message.header(messages::make_header(stamp_ns, parent));
  message.child_frame_id(child);
  message.transform(messages::to_transform_message(parent_from_child));
  return message;
}

/// Row by row, as the messages have it.
std::array<double, 36> row_by_row(const Matrix6& matrix) {
  std::array<double, 36> values{};
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(values.data()) = matrix;
  return values;
}

/// Nodes of before ROS 2 began names with a slash.
std::string without_slash(const std::string& frame) {
  return frame.substr(frame.starts_with('/') ? 1 : 0);
}

}  // namespace

OdometryOutput::OdometryOutput(service::ServiceContext& context, const FramesConfig& config)
    : context_(context),
      names_{context.frame("map"), context.frame("odom"), context.frame(config.base)},
      publish_tf_(config.publish_tf),
      publisher_(topics::advertise(context.bus, topics::kOdometry, topics::kTracker)),
      tf_(topics::advertise(context.bus, topics::kTransforms, topics::kTracker)) {
  subscriptions_.push_back(topics::subscribe(context.bus, topics::kStaticTransforms, topics::kTracker,
                                             [this](const Transforms& m) { take(*m, true); }));
  subscriptions_.push_back(topics::subscribe(
      context.bus, topics::kTransforms, topics::kTracker,
      [this, self = context.bus.id()](const Transforms& m, const bus::ParticipantId& writer) {
        if (writer != self) take(*m, false);
      }));
}

void OdometryOutput::take(const tf2_msgs::msg::TFMessage& message, bool is_static) {
  for (const auto& transform : message.transforms()) {
    const auto pose = messages::to_pose(transform.transform());
    if (!pose) {
      context_.diagnostics.reject(topics::kTransforms.name, service::Rejection::kInvalid, pose.error());
      continue;
    }
    const std::string parent = without_slash(transform.header().frame_id());
    const std::string child = without_slash(transform.child_frame_id());
    const std::lock_guard lock(mutex_);
    if (is_static)
      tree_.set_static(parent, child, *pose);
    else
      tree_.set(parent, child, messages::to_nanoseconds(transform.header().stamp()), *pose);
  }
}

std::optional<geometry::Pose> OdometryOutput::look_up(const std::string& target, const std::string& source,
                                                      std::int64_t stamp_ns) {
  const std::lock_guard lock(mutex_);
  return tree_.lookup(without_slash(target), without_slash(source), stamp_ns);
}

void OdometryOutput::publish(std::int64_t stamp_ns, const FrameResult& result,
                             const std::string& camera_frame) {
  const RobotFrames frames = [&] {
    const std::lock_guard lock(mutex_);
    return robot_frames(tree_, names_, without_slash(camera_frame), stamp_ns);
  }();
  const bool is_placed = result.submap == Submaps::kMap;
  const OdometryStep step = odometry_.step(
      {stamp_ns, result.map_from_camera, result.information, result.state != State::kRelocalised, is_placed,
       result.carried_covariance, result.map_covariance},
      frames);
  if (step.is_in_map && !is_placed) return;  // all that could be told
  nav_msgs::msg::Odometry odometry;
  odometry.header(messages::make_header(stamp_ns, step.is_in_map ? names_.map : names_.odom));
  odometry.child_frame_id(frames.child);
  odometry.pose().pose(messages::to_pose_message(step.parent_from_child));
  odometry.pose().covariance(row_by_row(step.pose_covariance));
  auto& twist = odometry.twist().twist();
  twist.linear().x(step.twist[0]);
  twist.linear().y(step.twist[1]);
  twist.linear().z(step.twist[2]);
  twist.angular().x(step.twist[3]);
  twist.angular().y(step.twist[4]);
  twist.angular().z(step.twist[5]);
  odometry.twist().covariance(row_by_row(step.twist_covariance));
  publisher_.write(odometry);
  tf2_msgs::msg::TFMessage tf;
  if (step.map_from_odom)
    tf.transforms().push_back(transform(stamp_ns, names_.map, names_.odom, *step.map_from_odom));
  if (step.odom_from_body)
    tf.transforms().push_back(transform(stamp_ns, names_.odom, frames.body, *step.odom_from_body));
  if (publish_tf_ && !tf.transforms().empty()) tf_.write(tf);
}

}  // namespace rds::tracker
