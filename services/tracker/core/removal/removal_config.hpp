// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/config_reader.hpp"

namespace rds::tracker {

/// What of a picture is not trusted because something that can move shows there.
struct RemovalConfig {
  std::string method = "depth";     // or "box": all that a predicted box shows; "off": nothing
  bool motion = true;               // with "depth": also what stands where nothing stood before
  double reach_m = 0.15;            // how far beyond its predicted box an object is looked for
  double step_m = 0.05;             // between neighbouring cells of one surface, 1 m away
  double min_component = 0.35;      // share of the largest surface in a box that others need to belong to it
  double carry_s = 0.5;             // how long a part stays cut that neither box nor motion supports
  double motion_step_m = 0.1;       // nearer than what stood there before, 1 m away; grows with depth squared
  double min_motion_share = 0.004;  // of the picture, of a moving thing
  double max_motion_share = 0.4;    // of what can be judged; more is an error of the pose
  double reference_s = 0.25;        // between the pictures that a new one is compared with
  int references = 2;               // pictures it is compared with
  bool operator==(const RemovalConfig&) const = default;
};

void read(config::ConfigReader& reader, RemovalConfig& config);

}  // namespace rds::tracker
