// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/core/transformer_config.hpp"

namespace rds::transformer {

void read(config::ConfigReader& reader, TransformerConfig& config) {
  reader.value("min_depth_m", config.min_depth_m, 0.01, 100.0, "m");
  reader.value("max_depth_m", config.max_depth_m, 0.01, 1000.0, "m");
  labels::read(reader, config.labels);
  if (config.min_depth_m >= config.max_depth_m)
    reader.violation("min_depth_m", fmt::format("{}", config.min_depth_m), "expected less than max_depth_m");
}

}  // namespace rds::transformer
