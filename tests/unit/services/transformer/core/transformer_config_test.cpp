// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/core/transformer_config.hpp"

#include <gmock/gmock.h>

namespace rds::transformer {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

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
