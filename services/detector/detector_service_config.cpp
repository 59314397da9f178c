// SPDX-License-Identifier: Apache-2.0
#include "services/detector/detector_service_config.hpp"

namespace rds::detector {

void read(config::ConfigReader& reader, DetectorServiceConfig& config) {
  reader.value("nice", config.nice, 0, 19);
  reader.value("lockstep", config.lockstep);
  reader.value("model_dir", config.model_dir);
  reader.value("detections_file", config.detections_file);
  read(reader, config.detector);
}

}  // namespace rds::detector
