// SPDX-License-Identifier: Apache-2.0
#include "services/detector/detector_service_config.hpp"

#include <gmock/gmock.h>

namespace rds::detector {
namespace {

/// Reads the shipped file over `config`; throws what is wrong with it.
DetectorServiceConfig read_shipped(DetectorServiceConfig config) {
  auto reader = config::ConfigReader::from_file(RDS_SOURCE_DIR "/services/detector/detector.yaml");
  read(reader, config);
  reader.finish();
  return config;
}

TEST(DetectorServiceConfig, ShippedFileSaysTheDefaults) {
  DetectorServiceConfig changed;
  // Values that differ from the defaults, so that a key missing from the file would show.
  changed.lockstep = true;
  changed.model_dir = "x";
  changed.detections_file = "x";
  const DetectorServiceConfig shipped = read_shipped(changed);
  const DetectorServiceConfig defaults;
  EXPECT_EQ(shipped.lockstep, defaults.lockstep);
  EXPECT_EQ(shipped.model_dir, defaults.model_dir);
  EXPECT_EQ(shipped.detections_file, defaults.detections_file);
}

}  // namespace
}  // namespace rds::detector
