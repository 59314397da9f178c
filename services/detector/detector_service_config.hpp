// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/config_reader.hpp"
#include "services/detector/core/detector_config.hpp"

namespace rds::detector {

struct DetectorServiceConfig {
  int nice = 10;                // the tracker has the processor first
  bool lockstep = false;        // every keyframe is looked at; otherwise only the newest
  std::string model_dir;        // looked through before $RDS_SHARED/models and the user's cache
  std::string detections_file;  // boxes from a recording instead of the network
  DetectorConfig detector;

  bool operator==(const DetectorServiceConfig&) const = default;
};

void read(config::ConfigReader& reader, DetectorServiceConfig& config);

}  // namespace rds::detector
