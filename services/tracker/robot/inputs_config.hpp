// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rds::tracker {

/// Topics of what a robot senses besides pictures, without the leading rt/; empty: not read.
struct InputsConfig {
  std::string odometry;      // nav_msgs/Odometry of wheels, legs or another camera
  std::string imu;           // sensor_msgs/Imu
  std::string initial_pose;  // geometry_msgs/PoseWithCovarianceStamped, in the map

  bool operator==(const InputsConfig&) const = default;
};

}  // namespace rds::tracker
