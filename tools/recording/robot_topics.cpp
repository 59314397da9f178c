// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/robot_topics.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "common/messages/conversions.hpp"
#include "common/messages/sensors/imu_conversions.hpp"
#include "common/topics/topics.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "tf2_msgs/msg/TFMessage.h"
#include "tools/recording/decode.hpp"

namespace rds::recording {
namespace {

/// "odom" of "/robot1/odom".
std::string last_part(const std::string& name) {
  return name.substr(name.find_last_of('/') + 1);
}

/// Nodes of before ROS 2 began names with a slash.
std::string frame_name(const std::string& frame) {
  return frame.substr(frame.starts_with('/') ? 1 : 0);
}

/// The best topic of one kind. @param word  that its name should have. @return nullptr if there is none.
template <class Kind, class Count>
const std::pair<const std::string, Kind>* best(const std::map<std::string, Kind>& topics, const char* ours,
                                               const char* word, Count count) {
  const auto rank = [&](const auto& topic) {
    return std::tuple(topic.first != std::string("/") + ours, topic.first.find(word) == std::string::npos,
                      -static_cast<std::int64_t>(count(topic.second)));
  };
  const auto found =
      std::ranges::min_element(topics, [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return found == topics.end() ? nullptr : &*found;
}

/// By stamp, each once.
template <class Sample>
std::vector<Sample> tidy(std::vector<Sample> samples) {
  std::ranges::stable_sort(samples, {}, &Sample::stamp_ns);
  const auto repeated = std::ranges::unique(samples, {}, &Sample::stamp_ns);
  samples.erase(repeated.begin(), repeated.end());
  return samples;
}

std::string not_joined(const RobotTopics::Place& place, const std::string& topic, const std::string& frame) {
  return fmt::format("{}: {} is not used: no tf joins its frame '{}' with the camera's, '{}'\n", place.file,
                     topic, frame, place.camera_frame);
}

}  // namespace

void RobotTopics::see(const BagTopic& topic, const BagMessage& message) {
  if (topic.type == "tf2_msgs/msg/TFMessage") see_transforms(topic.name, message);
  if (topic.type == "sensor_msgs/msg/Imu") see_imu(topic.name, message);
  if (topic.type != "nav_msgs/msg/Odometry") return;
  if (topic.name.ends_with(topics::kOdometry.name))
    has_tracker_ = true;
  else
    see_odometry(topic.name, message);
}

void RobotTopics::see_imu(const std::string& topic, const BagMessage& message) {
  const auto imu = decode<sensor_msgs::msg::Imu>(message.data);
  if (!imu) return;
  const image::ImuMeasurement measurement = messages::to_measurement(*imu);
  if (!measurement.acceleration.allFinite() || !measurement.turn_rate.allFinite()) return;
  Imu& its = imus_[topic];
  its.frame = frame_name(imu->header().frame_id());
  its.track.has_gyroscope = messages::has_gyroscope(*imu);
  its.track.measurements.push_back(measurement);
}

void RobotTopics::see_odometry(const std::string& topic, const BagMessage& message) {
  const auto odometry = decode<nav_msgs::msg::Odometry>(message.data);
  if (!odometry) return;
  const auto pose = messages::to_pose(odometry->pose().pose());
  if (!pose) return;
  Odometry& its = odometry_[topic];
  its.body = frame_name(odometry->child_frame_id());
  its.poses.push_back({messages::to_nanoseconds(odometry->header().stamp()), *pose, ""});
}

void RobotTopics::see_transforms(const std::string& topic, const BagMessage& message) {
  const auto transforms = decode<tf2_msgs::msg::TFMessage>(message.data);
  if (!transforms) return;
  const bool is_static = last_part(topic) == topics::kStaticTransforms.name;
  for (const auto& transform : transforms->transforms()) {
    const auto pose = messages::to_pose(transform.transform());
    if (!pose) continue;
    const std::string parent = frame_name(transform.header().frame_id());
    const std::string child = frame_name(transform.child_frame_id());
    if (placed_.insert(child).second || is_static) tree_.set_static(parent, child, *pose);
    if (is_static || last_part(parent) != "odom") continue;
    Odometry& its = odometry_by_tf_[child];
    its.body = child;
    its.poses.push_back({messages::to_nanoseconds(transform.header().stamp()), *pose, ""});
  }
}

std::optional<geometry::Pose> RobotTopics::look_up(const std::string& target,
                                                   const std::string& source) const {
  return tree_.lookup(frame_name(target), frame_name(source), 0);
}

const std::map<std::string, RobotTopics::Odometry>& RobotTopics::all_odometry() const {
  static const std::map<std::string, Odometry> kNone;
  if (!odometry_.empty()) return odometry_;
  return has_tracker_ ? kNone : odometry_by_tf_;
}

std::optional<image::ImuTrack> RobotTopics::imu(const Place& place, std::string& notes) const {
  const auto* found =
      best(imus_, topics::kImu.name, "imu", [](const Imu& its) { return its.track.measurements.size(); });
  if (found == nullptr) return std::nullopt;
  const auto& [topic, its] = *found;
  const auto camera_from_imu = look_up(place.camera_frame, its.frame);
  notes +=
      camera_from_imu ? fmt::format("{}: IMU {}\n", place.file, topic) : not_joined(place, topic, its.frame);
  if (!camera_from_imu) return std::nullopt;
  return image::ImuTrack{*camera_from_imu, its.track.has_gyroscope, tidy(its.track.measurements)};
}

std::optional<image::OdometryTrack> RobotTopics::odometry(const Place& place, std::string& notes) const {
  const auto* found = best(all_odometry(), topics::kRobotOdometry.name, "odom",
                           [](const Odometry& its) { return its.poses.size(); });
  if (found == nullptr) return std::nullopt;
  const auto& [name, its] = *found;
  const std::string source = odometry_.empty() ? fmt::format("tf from odom to {}", name) : name;
  const auto body_from_camera = look_up(its.body, place.camera_frame);
  notes += body_from_camera ? fmt::format("{}: odometry {}\n", place.file, source)
                            : not_joined(place, source, its.body);
  if (!body_from_camera) return std::nullopt;
  return image::OdometryTrack{*body_from_camera, tidy(its.poses)};
}

image::RobotSensors RobotTopics::sensors(const Place& place, std::string& notes) const {
  return {imu(place, notes), odometry(place, notes)};
}

}  // namespace rds::recording
