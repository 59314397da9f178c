// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/config_reader.hpp"
#include "common/labels/table.hpp"

namespace rds::tracker::prediction {

struct PredictionConfig {
  std::string algorithm = "kalman3d";  // or "paper"
  labels::Table labels;                // which of them are movable
  double min_score = 0.35;             // detections with less are ignored

  bool operator==(const PredictionConfig&) const = default;
};

inline void read(config::ConfigReader& reader, PredictionConfig& config) {
  reader.choice("algorithm", config.algorithm, {"paper", "kalman3d"});
  reader.value("min_score", config.min_score, 0.0, 1.0);
}

}  // namespace rds::tracker::prediction
