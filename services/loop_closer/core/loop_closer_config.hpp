// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"

namespace rds::loop_closer {

/// What depends on the camera, the place and the machine; the counts and gates of the method are constants
/// beside the code that they belong to.
struct LoopCloserConfig {
  int max_features = 1500;   // kept per keyframe
  double max_depth_m = 6.0;  // features farther away are not used

  bool operator==(const LoopCloserConfig&) const = default;
};

void read(config::ConfigReader& reader, LoopCloserConfig& config);

}  // namespace rds::loop_closer
