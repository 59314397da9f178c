// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace rds::tracker {

/// The frames that odometry and transforms are told in, and whether they are.
struct FramesConfig {
  std::string base = "base_link";  // of the robot, if its tree has it
  bool publish_tf = true;

  bool operator==(const FramesConfig&) const = default;
};

}  // namespace rds::tracker
