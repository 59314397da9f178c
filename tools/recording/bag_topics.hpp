// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/trajectory.hpp"
#include "sensor_msgs/msg/CameraInfo.h"
#include "tools/recording/robot_topics.hpp"
#include "tools/recording/stream.hpp"

namespace rds::recording {

/// What one pass through a bag finds: pictures, cameras, true paths, and what else a robot has sensed.
class BagTopics {
 public:
  using Camera = std::pair<const std::string, sensor_msgs::msg::CameraInfo>;  // by topic, the first message

  void see(const BagTopic& topic, const BagMessage& message, const BagPlace& place);

  /// The pictures to take; nullptr if there are none. Of several topics that of this project's name, then one
  /// that a name marks as colour or as registered depth, then the one with the most pictures.
  [[nodiscard]] const Stream* best(Content content) const;
  /// The camera's description beside a topic of pictures; nullptr if there is none.
  [[nodiscard]] const Camera* camera_beside(const std::string& topic) const;
  /// That, or the only one.
  [[nodiscard]] const Camera* camera_of(const std::string& topic) const;
  /// nullptr if there is none.
  [[nodiscard]] const std::vector<geometry::StampedPose>* truth() const;
  [[nodiscard]] const RobotTopics& robot() const { return robot_; }

 private:
  void see_picture(const BagTopic& topic, const BagMessage& message, const BagPlace& place);
  template <class Message, class PoseOf>
  void see_pose(const std::string& topic, const BagMessage& message, PoseOf pose_of);

  std::map<std::string, Stream> streams_;  // by topic
  std::map<std::string, sensor_msgs::msg::CameraInfo> cameras_;
  std::map<std::string, std::vector<geometry::StampedPose>> truths_;
  RobotTopics robot_;
};

/// "/camera/color" of "/camera/color/image_raw".
std::string parent_of(const std::string& topic);

}  // namespace rds::recording
