// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/loop_closer_service_config.hpp"

namespace rds::loop_closer {

void read(config::ConfigReader& reader, LoopCloserServiceConfig& config) {
  reader.value("nice", config.nice, 0, 19);
  reader.value("lockstep", config.lockstep);
  reader.value("map_file", config.map_file);
  reader.value("localize_only", config.localize_only);
  read(reader, config.maps);
  read(reader, config.loop_closer);
}

}  // namespace rds::loop_closer
