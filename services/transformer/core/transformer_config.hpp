// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "common/config/config_reader.hpp"

namespace rds::transformer {

struct TransformerConfig {
  double min_depth_m = 0.2;  // nearer or further depths are measuring faults
  double max_depth_m = 10.0;
  double default_thickness_m = 0.4;  // of objects along the viewing direction
  std::map<std::string, double, std::less<>> thickness_m = {{"person", 0.6}, {"bottle", 0.1}};  // by label

  bool operator==(const TransformerConfig&) const = default;
};

/// Reads the settings; a thickness must be in (0, 10] m.
void read(config::ConfigReader& reader, TransformerConfig& config);

double thickness_m(const TransformerConfig& config, std::string_view label);

}  // namespace rds::transformer
