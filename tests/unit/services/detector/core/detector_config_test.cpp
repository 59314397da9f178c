// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/detector_config.hpp"

#include <gmock/gmock.h>

namespace rds::detector {
namespace {

TEST(DetectorConfig, NamesValuesOutOfRange) {
  config::ConfigReader reader(
      YAML::Load("{threads: 0, backend: abacus, precision: f16, depth: {max_depth_m: 0}}"), "detector.yaml");
  DetectorConfig config;
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(),
                ::testing::AllOf(::testing::HasSubstr("threads: 0, expected 1 … 64"),
                                 ::testing::HasSubstr("backend: abacus, expected openvino, opencv, or empty"),
                                 ::testing::HasSubstr("precision: f16, expected one of: f32, bf16"),
                                 ::testing::HasSubstr("depth.max_depth_m: 0")));
  }
}

}  // namespace
}  // namespace rds::detector
