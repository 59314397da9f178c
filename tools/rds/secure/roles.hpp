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

/// The services; and the kinds of outsiders: an operator, who alone commands, a reader of maps, a player of
/// recordings, a camera's driver and a
/// router of Zenoh.
///
/// @param camera_topics  all topics of the camera.
std::vector<Role> roles(const std::vector<std::string>& camera_topics);

}  // namespace rds::secure
