// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/config_reader.hpp"
#include "common/labels/table.hpp"

namespace rds::transformer {

struct TransformerConfig {
  double min_depth_m = 0.2;  // nearer or further depths are measuring faults
  double max_depth_m = 10.0;
  labels::Table labels;  // how thick objects are along the viewing direction

  bool operator==(const TransformerConfig&) const = default;
};

void read(config::ConfigReader& reader, TransformerConfig& config);

}  // namespace rds::transformer
