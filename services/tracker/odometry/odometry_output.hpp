// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/service/service.hpp"
#include "nav_msgs/msg/Odometry.h"
#include "services/tracker/core/tracking_types.hpp"
#include "services/tracker/odometry/frames_config.hpp"
#include "services/tracker/odometry/odometry.hpp"
#include "tf2_msgs/msg/TFMessage.h"

namespace rds::tracker {

/// Publishes the robot's pose as odometry and transforms, beside those that other nodes publish, which it
/// reads: no frame gets a second parent (RobotFrames).
class OdometryOutput {
 public:
  OdometryOutput(service::ServiceContext& context, const FramesConfig& config);

  /// @param camera_frame  frame_id of the pictures.
  void publish(std::int64_t stamp_ns, const FrameResult& result, const std::string& camera_frame);
  void move_map(const geometry::Pose& corrected_map_from_map) { odometry_.move_map(corrected_map_from_map); }
  /// Where `source` is in `target` by the transforms that others publish; nullopt if no path joins them.
  [[nodiscard]] std::optional<geometry::Pose> look_up(const std::string& target, const std::string& source,
                                                      std::int64_t stamp_ns);
  void begin_map() { odometry_.begin_map(); }
  void publish_tf(bool published) { publish_tf_ = published; }

 private:
  void take(const tf2_msgs::msg::TFMessage& message, bool is_static);

  service::ServiceContext& context_;
  FrameNames names_;
  bool publish_tf_;  // the worker's
  Odometry odometry_;
  bus::Publisher<nav_msgs::msg::Odometry> publisher_;
  bus::Publisher<tf2_msgs::msg::TFMessage> tf_;
  std::mutex mutex_;  // of the tree
  geometry::TransformTree tree_;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks use the members above
};

}  // namespace rds::tracker
