// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/loop_closer_service_config.hpp"

#include <gmock/gmock.h>

namespace rds::loop_closer {
namespace {

/// Reads the shipped file over `config`; throws what is wrong with it.
LoopCloserServiceConfig read_shipped(LoopCloserServiceConfig config) {
  auto reader = config::ConfigReader::from_file(RDS_SOURCE_DIR "/services/loop_closer/loop_closer.yaml");
  read(reader, config);
  reader.finish();
  return config;
}

TEST(LoopCloserServiceConfig, ShippedFileSaysTheDefaults) {
  LoopCloserServiceConfig changed;
  // Values that differ from the defaults, so that a key missing from the file would show.
  changed.lockstep = true;
  changed.map_file = "x";
  changed.localize_only = true;
  const LoopCloserServiceConfig shipped = read_shipped(changed);
  const LoopCloserServiceConfig defaults;
  EXPECT_EQ(shipped.lockstep, defaults.lockstep);
  EXPECT_EQ(shipped.map_file, defaults.map_file);
  EXPECT_EQ(shipped.localize_only, defaults.localize_only);
}

}  // namespace
}  // namespace rds::loop_closer
