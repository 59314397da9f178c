// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/removal_config.hpp"

namespace rds::tracker {

void read(config::ConfigReader& reader, RemovalConfig& config) {
  reader.choice("method", config.method, {"depth", "box", "off"});
  reader.value("motion", config.motion);
  reader.value("reach_m", config.reach_m, 0.0, 2.0, "m");
  reader.value("step_m", config.step_m, 0.005, 0.5, "m");
  reader.value("min_component", config.min_component, 0.0, 1.0);
  reader.value("carry_s", config.carry_s, 0.0, 10.0, "s");
  reader.value("motion_step_m", config.motion_step_m, 0.02, 2.0, "m");
  reader.value("min_motion_share", config.min_motion_share, 0.0, 1.0);
  reader.value("max_motion_share", config.max_motion_share, 0.0, 1.0);
  reader.value("reference_s", config.reference_s, 0.02, 5.0, "s");
  reader.value("references", config.references, 1, 20);
}

}  // namespace rds::tracker
