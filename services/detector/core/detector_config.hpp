// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/config_reader.hpp"
#include "common/labels/table.hpp"

namespace rds::detector {

/// Settings of the detector; what belongs to one network is in its NetworkDescription.
struct DetectorConfig {
  std::string network;            // name of the network; empty: the best one whose file is found
  std::string backend;            // inference library: openvino or opencv; empty: the first of backends()
  std::string precision = "f32";  // of the computation: f32, or bf16 (openvino only)
  int threads = 1;                // of the inference library
  double score_threshold = 0;     // 0: the network's own
  double other_label_iou = 0.85;  // as in SuppressionConfig; no setting, tests and benchmarks vary it
  double max_depth_m = 20.0;      // what is further away counts as no measurement
  labels::Table labels;           // the one spelling of each label

  bool operator==(const DetectorConfig&) const = default;
};

void read(config::ConfigReader& reader, DetectorConfig& config);

}  // namespace rds::detector
