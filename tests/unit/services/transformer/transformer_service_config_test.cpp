// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/transformer_service_config.hpp"

#include <gmock/gmock.h>

namespace rds::transformer {
namespace {

/// Reads the shipped file over `config`; throws what is wrong with it.
TransformerServiceConfig read_shipped(TransformerServiceConfig config) {
  auto reader = config::ConfigReader::from_file(RDS_SOURCE_DIR "/services/transformer/transformer.yaml");
  read(reader, config);
  reader.finish();
  return config;
}

TEST(TransformerServiceConfig, ShippedFileSaysTheDefaults) {
  TransformerServiceConfig changed;
  // Values that differ from the defaults, so that a key missing from the file would show.
  changed.camera_info_topic = "x";
  const TransformerServiceConfig shipped = read_shipped(changed);
  const TransformerServiceConfig defaults;
  EXPECT_EQ(shipped.camera_info_topic, defaults.camera_info_topic);
}

}  // namespace
}  // namespace rds::transformer
