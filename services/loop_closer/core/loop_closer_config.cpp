// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_closer_config.hpp"

namespace rds::loop_closer {

void read(config::ConfigReader& reader, LoopCloserConfig& config) {
  reader.value("max_features", config.max_features, 50, 10'000);
  reader.section("verification").value("max_depth_m", config.max_depth_m, 0.5, 100.0, "m");
}

}  // namespace rds::loop_closer
