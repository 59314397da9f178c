// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_closer_config.hpp"

#include <gmock/gmock.h>

namespace rds::loop_closer {
namespace {

TEST(LoopCloserConfig, ListsEveryValueOutOfRange) {
  LoopCloserConfig config;
  config::ConfigReader reader(YAML::Load("{max_features: 2, verification: {max_depth_m: -1}, typo: 1}"), "x");
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), ::testing::AllOf(::testing::HasSubstr("max_features"),
                                           ::testing::HasSubstr("verification.max_depth_m"),
                                           ::testing::HasSubstr("typo")));
  }
}

}  // namespace
}  // namespace rds::loop_closer
