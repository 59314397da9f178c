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
  EXPECT_EQ(config, TransformerConfig());
}

TEST(TransformerConfig, NamesEveryViolation) {
  config::ConfigReader reader(
      YAML::Load("{min_depth_m: 3, max_depth_m: 2, labels_file: /no/such.yaml, thickness_m: {person: 1}}"), "test.yaml");
  TransformerConfig config;
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("min_depth_m: 3"), HasSubstr("labels_file: /no/such.yaml"),
                                HasSubstr("thickness_m: unknown key")));
  }
}

}  // namespace
}  // namespace rds::transformer
