// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <span>
#include <string>

#include "common/bus/participant.hpp"
#include "common/geometry/keyframe_pose.hpp"
#include "common/service/service.hpp"
#include "nav_msgs/msg/Path.h"

namespace rds::tracker {

/// The camera's way in the map as a nav_msgs/Path, a pose per keyframe: for RViz, and what else shows one.
/// While somebody reads it, at most once a second.
class PathOutput {
 public:
  explicit PathOutput(service::ServiceContext& context);

  /// True while a new subscriber has not got the path.
  [[nodiscard]] bool has_new_reader();
  /// @param poses  of the map's keyframes, by id. @param is_last  nothing may follow: it is written at once.
  void publish(std::span<const geometry::KeyframePose> poses, bool is_last);

 private:
  using Clock = std::chrono::steady_clock;

  std::string map_frame_;
  bus::Publisher<nav_msgs::msg::Path> publisher_;
  int informed_readers_ = 0;
  Clock::time_point written_;
};

}  // namespace rds::tracker
