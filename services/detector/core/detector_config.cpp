// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/detector_config.hpp"

namespace rds::detector {

void read(config::ConfigReader& reader, DetectorConfig& config) {
  reader.value("network", config.network);
  reader.value("backend", config.backend);
  if (!config.backend.empty() && config.backend != "openvino" && config.backend != "opencv")
    reader.violation("backend", config.backend,
                     "expected openvino, opencv, or empty for the faster one built in");
  reader.choice("precision", config.precision, {"f32", "bf16"});
  reader.value("threads", config.threads, 1, 64);
  reader.value("score_threshold", config.score_threshold, 0.0, 1.0);
  reader.section("depth").value("max_depth_m", config.max_depth_m, 0.1, 1000.0, "m");
  labels::read(reader, config.labels);
}

}  // namespace rds::detector
