// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "common/bus/participant.hpp"
#include "common/geometry/trajectory.hpp"
#include "nav_msgs/msg/Odometry.h"

namespace rds::play {

/// Of a recording: what a robot's odometry told of the camera.
inline constexpr const char* kOdometryFile = "odometry.txt";

/// Publishes a TUM trajectory as a robot's odometry: of the camera's optical frame, in a frame of its own,
/// poses alone.
class OdometryPlayer {
 public:
  /// @param bus  nothing is published before publish_through().
  /// @throws std::runtime_error with one sentence if the file cannot be read or tells of no pose.
  OdometryPlayer(bus::Participant& bus, const std::filesystem::path& file);

  /// Those that were not published yet, up to the first one that is not before this stamp of the recording:
  /// between two of them every time until then can be interpolated.
  /// @param shift_ns  that stamps are told later by. Where it grows the recording begins again.
  void publish_through(std::int64_t stamp_ns, std::int64_t shift_ns);

 private:
  std::vector<geometry::StampedPose> poses_;
  std::size_t next_ = 0;
  std::int64_t shift_ns_ = 0;
  bus::Publisher<nav_msgs::msg::Odometry> publisher_;
};

}  // namespace rds::play
