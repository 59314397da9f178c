// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/conversion.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "common/messages/conversions.hpp"
#include "common/messages/definitions.hpp"
#include "common/messages/registry.hpp"
#include "common/topics/topics.hpp"
#include "geometry_msgs/msg/PoseStamped.h"
#include "tools/recording/bag/qos_profiles.hpp"
#include "tools/recording/camera_messages.hpp"

namespace rds::recording {
namespace {

using geometry_msgs::msg::PoseStamped;
using Result = tl::expected<void, std::string>;

/// What an older bag does not say of a type that is ours.
BagTopic completed(BagTopic topic) {
  if (!topic.definition.empty()) return topic;
  for (const auto& type : messages::message_types())
    if (type.ops->ros_name == topic.type) return topic_of(topic.name, *type.ops, topic.qos);
  return topic;
}

/// A camera's topics in a bag that is being written.
class CameraBag {
 public:
  explicit CameraBag(BagWriter& bag) : bag_(bag) {}

  Result add_topics(const image::Recording& recording) {
    for (const auto& [number, name, type] : topics(recording)) {
      const bool is_latched = number == &mounting_;
      const auto added =
          bag_.add_topic(topic_of(std::string("/") + name, *type, offered_qos_profile(true, is_latched)));
      if (!added) return tl::unexpected(added.error());
      *number = *added;
    }
    return {};
  }
  Result write_color(const image::ColorImage& color, const geometry::CameraModel& camera,
                     std::int64_t stamp_ns) {
    if (auto done = write(camera_info_, camera_info_message(camera, stamp_ns), stamp_ns); !done) return done;
    return write(color_, color_message(color, stamp_ns), stamp_ns);
  }
  Result write_depth(const image::DepthImage& depth, std::int64_t stamp_ns) {
    return write(depth_, depth_message(depth, stamp_ns), stamp_ns);
  }
  Result write_truth(const geometry::StampedPose& pose) {
    PoseStamped message;
    message.header(messages::make_header(pose.stamp_ns, "world"));
    message.pose(messages::to_pose_message(pose.map_from_camera));
    return write(truth_, message, pose.stamp_ns);
  }
  Result write_odometry(const image::OdometryTrack& of, std::size_t index) {
    const geometry::StampedPose& pose = of.odom_from_body[index];
    return write(odometry_, odometry_message(of, pose.map_from_camera, pose.stamp_ns), pose.stamp_ns);
  }
  Result write_imu(const image::ImuTrack& of, std::size_t index) {
    const image::ImuMeasurement& measurement = of.measurements[index];
    return write(imu_, imu_message(of, measurement, measurement.stamp_ns), measurement.stamp_ns);
  }
  Result write_mounting(const image::RobotSensors& sensors, std::int64_t stamp_ns) {
    const auto mounting = mounting_message(sensors);
    return mounting ? write(mounting_, *mounting, stamp_ns) : Result();
  }
  [[nodiscard]] std::uint64_t written() const { return written_; }

 private:
  using NewTopic = std::tuple<std::size_t*, const char*, const bus::TypeOps*>;
  std::vector<NewTopic> topics(const image::Recording& recording) {
    const auto& image = bus::type_ops<sensor_msgs::msg::Image>();
    std::vector<NewTopic> topics{
        {&color_, topics::kColor.name, &image},
        {&camera_info_, topics::kCameraInfo.name, &bus::type_ops<sensor_msgs::msg::CameraInfo>()},
        {&depth_, topics::kDepth.name, &image}};
    if (recording.ground_truth()) topics.emplace_back(&truth_, "groundtruth", &bus::type_ops<PoseStamped>());
    if (recording.sensors().odometry)
      topics.emplace_back(&odometry_, topics::kRobotOdometry.name, &bus::type_ops<nav_msgs::msg::Odometry>());
    if (recording.sensors().imu)
      topics.emplace_back(&imu_, topics::kImu.name, &bus::type_ops<sensor_msgs::msg::Imu>());
    if (mounting_message(recording.sensors()))
      topics.emplace_back(&mounting_, topics::kStaticTransforms.name,
                          &bus::type_ops<tf2_msgs::msg::TFMessage>());
    return topics;
  }
  template <class Message>
  Result write(std::size_t topic, const Message& message, std::int64_t stamp_ns) {
    const auto& type = bus::type_ops<Message>();
    Bytes bytes(type.encoded_size(&message));
    bytes.resize(type.encode(&message, bytes.data(), bytes.size()));
    ++written_;
    return bag_.write(topic, {stamp_ns, stamp_ns, bytes});
  }

  BagWriter& bag_;
  std::size_t color_ = 0;
  std::size_t camera_info_ = 0;
  std::size_t depth_ = 0;
  std::size_t truth_ = 0;
  std::size_t odometry_ = 0;
  std::size_t imu_ = 0;
  std::size_t mounting_ = 0;
  std::uint64_t written_ = 0;
};

enum class Kind { kTruth, kOdometry, kImu, kColor, kDepth };

/// Everything of a recording by stamp: (stamp, what, index).
std::vector<std::tuple<std::int64_t, Kind, std::size_t>> in_order_of_time(const image::Recording& recording) {
  std::vector<std::tuple<std::int64_t, Kind, std::size_t>> all;
  for (const auto& frame : recording.frames()) all.emplace_back(frame.stamp_ns, Kind::kColor, frame.index);
  for (std::size_t i = 0; i < recording.depth_stamps().size(); ++i)
    all.emplace_back(recording.depth_stamps()[i], Kind::kDepth, i);
  const auto add = [&](Kind kind, const auto& samples) {
    for (std::size_t i = 0; i < samples.size(); ++i) all.emplace_back(samples[i].stamp_ns, kind, i);
  };
  if (recording.ground_truth()) add(Kind::kTruth, *recording.ground_truth());
  if (const auto& odometry = recording.sensors().odometry) add(Kind::kOdometry, odometry->odom_from_body);
  if (const auto& imu = recording.sensors().imu) add(Kind::kImu, imu->measurements);
  std::ranges::sort(all);
  return all;
}

}  // namespace

BagTopic topic_of(const std::string& name, const bus::TypeOps& type, const std::string& qos) {
  return {.name = name,
          .type = type.ros_name,
          .qos = qos,
          .type_hash = type.type_hash,
          .definition_encoding = "ros2msg",
          .definition = std::string(messages::definition_of(type.ros_name))};
}

tl::expected<Converted, std::string> copy_bag(Bag& from, BagWriter& to) {
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> numbers;  // by name, type, QoS
  Result result;
  const auto scan = from.scan([&](const BagTopic& topic, const BagMessage& message, const BagPlace&) {
    if (!result) return;
    const auto [number, is_new] = numbers.try_emplace({topic.name, topic.type, topic.qos});
    if (is_new) {
      const auto added = to.add_topic(completed(topic));
      if (!added) result = tl::unexpected(added.error());
      if (added) number->second = *added;
    }
    if (result) result = to.write(number->second, message);
  });
  if (!scan) return tl::unexpected(scan.error());
  if (result) result = to.finish();
  if (!result) return tl::unexpected(result.error());
  return Converted{scan->messages, 0, scan->fault};
}

tl::expected<Converted, std::string> write_bag(const image::Recording& recording, BagWriter& to) {
  CameraBag bag(to);
  Converted converted;
  const auto note_unreadable = [&](const std::string& sentence) {
    if (converted.unreadable++ == 0) converted.fault = sentence;
    return Result();
  };
  const auto write_one = [&](Kind kind, std::int64_t stamp_ns, std::size_t index) -> Result {
    if (kind == Kind::kTruth) return bag.write_truth((*recording.ground_truth())[index]);
    if (kind == Kind::kOdometry) return bag.write_odometry(*recording.sensors().odometry, index);
    if (kind == Kind::kImu) return bag.write_imu(*recording.sensors().imu, index);
    if (kind == Kind::kColor) {
      const auto color = recording.load_color(index);
      return color ? bag.write_color(*color, recording.camera(), stamp_ns) : note_unreadable(color.error());
    }
    const auto depth = recording.load_depth(index);
    return depth ? bag.write_depth(*depth, stamp_ns) : note_unreadable(depth.error());
  };
  const auto in_order = in_order_of_time(recording);
  Result result = bag.add_topics(recording);
  if (result) result = bag.write_mounting(recording.sensors(), std::get<0>(in_order.front()));
  for (const auto& [stamp_ns, kind, index] : in_order)
    if (result) result = write_one(kind, stamp_ns, index);
  if (result) result = to.finish();
  if (!result) return tl::unexpected(result.error());
  converted.items = bag.written();
  return converted;
}

}  // namespace rds::recording
