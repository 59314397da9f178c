// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/prediction_config.hpp"

#include <gmock/gmock.h>

namespace rds::tracker::prediction {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(PredictionConfig, ReadsWhatIsGivenAndKeepsTheOtherDefaults) {
  config::ConfigReader reader(
      YAML::Load("{algorithm: paper, paper: {max_age_s: 2.0}}"), "test.yaml");
  PredictionConfig config;
  read(reader, config);
  reader.finish();
  EXPECT_EQ(config.algorithm, "paper");
  EXPECT_EQ(config.paper.max_age_s, 2);
  EXPECT_EQ(config.kalman3d.max_age_s, Kalman3dConfig().max_age_s);
  EXPECT_TRUE(is_movable(config, "person"));
  EXPECT_FALSE(is_movable(config, "chair"));
}

TEST(PredictionConfig, NamesEveryViolation) {
  config::ConfigReader reader(
      YAML::Load("{algorithm: magic, kalman3d: {lateral_noise_m: 0}, region: {margin: 3}}"), "test.yaml");
  PredictionConfig config;
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("algorithm: magic"), HasSubstr("kalman3d.lateral_noise_m"),
                                HasSubstr("region.margin: unknown key")));
  }
}

}  // namespace
}  // namespace rds::tracker::prediction
