// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rds::secure {

/// Who takes part in a secured domain, and what it may do there. Topics without "rt/", with '*' for any text.
struct Role {
  std::string name;  // of its folder, its certificate and, after "rds-", its service
  std::vector<std::string> publishes;
  std::vector<std::string> subscribes;
  bool relays = false;  // on Zenoh, passes on what others may write and read
};

/// Topics of a domain that are no names of ours, with '*' for any text.
struct RobotTopics {
  std::vector<std::string> camera{"camera/*"};                      // all of the camera
  std::vector<std::string> sensors{"odom", "imu", "initialpose"};  // what else the robot senses or is told
};

/// The services; and the kinds of outsiders: an operator, who alone commands, a reader of maps, a player of
/// recordings, a camera's driver, the robot's other nodes and a router of Zenoh.
std::vector<Role> roles(const RobotTopics& topics);

}  // namespace rds::secure
