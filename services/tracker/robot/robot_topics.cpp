// SPDX-License-Identifier: Apache-2.0
// The topics that RobotInputs reads.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/messages/conversions.hpp"
#include "common/messages/sensors/imu_conversions.hpp"
#include "common/topics/endpoints.hpp"
#include "geometry_msgs/msg/PoseWithCovarianceStamped.h"
#include "nav_msgs/msg/Odometry.h"
#include "services/tracker/robot/robot_inputs.hpp"
#include "tf2_msgs/msg/TFMessage.h"

namespace rds::tracker {
namespace {

// In the rows of a covariance: x, y, z, then the angles about them.
constexpr std::size_t kXX = 0;
constexpr std::size_t kYY = 7;
constexpr std::size_t kYawYaw = 35;

double sigma_of(double variance) {
  return std::isfinite(variance) && variance > 0 ? std::sqrt(variance) : 0;
}

}  // namespace

void RobotInputs::read_odometry(const std::string& topic) {
  const auto take = [this](const std::shared_ptr<const nav_msgs::msg::Odometry>& m) {
    const auto pose = messages::to_pose(m->pose().pose());
    if (!pose)
      return context_.diagnostics.reject(topics::kRobotOdometry.name, service::Rejection::kInvalid,
                                         pose.error());
    told_.push({messages::to_nanoseconds(m->header().stamp()), *pose, m->child_frame_id()});
  };
  subscriptions_.push_back(
      topics::subscribe(context_.bus, topics::kRobotOdometry.named(topic), topics::kTracker, take));
  warn("odometry", odometry_fault_);
}

/// Where tf tells of the robot in that frame, directly. Frames of before ROS 2 began with a slash.
void RobotInputs::read_transforms(const std::string& frame) {
  using Message = tf2_msgs::msg::TFMessage;
  const auto take = [this, frame, self = context_.bus.id()](const std::shared_ptr<const Message>& m,
                                                            const bus::ParticipantId& writer) {
    if (writer == self) return;
    for (const auto& transform : m->transforms()) {
      const std::string& parent = transform.header().frame_id();
      if (parent != frame && parent != "/" + frame) continue;
      const auto pose = messages::to_pose(transform.transform());  // else OdometryOutput rejects it
      if (pose)
        told_.push({messages::to_nanoseconds(transform.header().stamp()), *pose, transform.child_frame_id()});
    }
  };
  subscriptions_.push_back(topics::subscribe(context_.bus, topics::kTransforms, topics::kTracker, take));
  warn("odometry", odometry_fault_);
}

/// @param fault  read under the lock.
void RobotInputs::warn(const std::string& name, const std::string& fault) {
  context_.diagnostics.warning(name, [this, &fault]() -> std::optional<std::string> {
    const std::lock_guard lock(mutex_);
    return fault.empty() ? std::nullopt : std::optional(fault);
  });
}

void RobotInputs::read_imu(const std::string& topic) {
  const auto take = [this](const std::shared_ptr<const sensor_msgs::msg::Imu>& m) {
    sensed_.push({messages::to_measurement(*m), messages::has_gyroscope(*m), m->header().frame_id()});
  };
  warn("imu", imu_fault_);
  subscriptions_.push_back(
      topics::subscribe(context_.bus, topics::kImu.named(topic), topics::kTracker, take));
}

void RobotInputs::read_initial_poses(const std::string& topic) {
  using Message = geometry_msgs::msg::PoseWithCovarianceStamped;
  const auto take = [this, map = context_.frame("map")](const std::shared_ptr<const Message>& m) {
    const auto refuse = [&](const std::string& why) {
      context_.diagnostics.reject(topics::kInitialPose.name, service::Rejection::kInvalid, why);
    };
    const auto pose = messages::to_pose(m->pose().pose());
    if (!pose) return refuse(pose.error());
    if (m->header().frame_id() != map) return refuse(fmt::format("expected a pose in {}", map));
    const auto& covariance = m->pose().covariance();
    said_.push({messages::to_nanoseconds(m->header().stamp()), *pose,
                sigma_of(std::max(covariance[kXX], covariance[kYY])), sigma_of(covariance[kYawYaw])});
  };
  subscriptions_.push_back(
      topics::subscribe(context_.bus, topics::kInitialPose.named(topic), topics::kTracker, take));
}

}  // namespace rds::tracker
