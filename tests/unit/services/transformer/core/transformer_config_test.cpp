// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/core/transformer_config.hpp"

#include <gmock/gmock.h>

namespace rds::transformer {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(TransformerConfig, ShippedFileEqualsTheDefaults) {
  auto reader = config::ConfigReader::from_file(RDS_SOURCE_DIR "/services/transformer/transformer.yaml");
  TransformerConfig config;
  config.min_depth_m = config.max_depth_m = config.default_thickness_m = -1;
  config.thickness_m = {};
  read(reader, config);
  const TransformerConfig defaults;
  EXPECT_EQ(config.min_depth_m, defaults.min_depth_m);
  EXPECT_EQ(config.max_depth_m, defaults.max_depth_m);
  EXPECT_EQ(config.default_thickness_m, defaults.default_thickness_m);
  EXPECT_EQ(config.thickness_m, defaults.thickness_m);
}

TEST(TransformerConfig, KeepsTheDefaultsWithoutAFile) {
  config::ConfigReader reader;
  TransformerConfig config;
  read(reader, config);
  reader.finish();
  EXPECT_EQ(config.thickness_m, TransformerConfig().thickness_m);
}

TEST(TransformerConfig, NamesEveryViolation) {
  config::ConfigReader reader(
      YAML::Load("{min_depth_m: 3, max_depth_m: 2, thickness_m: {person: -1}, thicknes: 1}"), "test.yaml");
  TransformerConfig config;
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("min_depth_m: 3"), HasSubstr("thickness_m.person: -1"),
                                HasSubstr("thicknes: unknown key")));
  }
}

}  // namespace
}  // namespace rds::transformer
