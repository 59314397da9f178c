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
};

/// The services; and the kinds of outsiders: an operator, who alone commands, a reader of maps, a player of
/// recordings and a camera's driver.
///
/// @param camera_topics  all topics of the camera.
std::vector<Role> roles(const std::vector<std::string>& camera_topics);

}  // namespace rds::secure
