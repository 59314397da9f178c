// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rds::tracker {

/// Topics of what a robot senses besides pictures, without the leading rt/; empty: not read.
struct InputsConfig {
  std::string odometry;        // nav_msgs/Odometry of wheels, legs or another camera
  std::string odometry_frame;  // in its place: the frame that tf tells the robot's base in
  std::string imu;             // sensor_msgs/Imu
  std::string initial_pose;    // geometry_msgs/PoseWithCovarianceStamped, in the map

  [[nodiscard]] bool reads_odometry() const { return !odometry.empty() || !odometry_frame.empty(); }
  /// For sentences.
  [[nodiscard]] std::string odometry_source() const {
    return odometry.empty() ? "tf, from " + odometry_frame : odometry;
  }

  bool operator==(const InputsConfig&) const = default;
};

}  // namespace rds::tracker
