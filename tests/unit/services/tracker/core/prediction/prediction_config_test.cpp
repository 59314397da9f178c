// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/prediction_config.hpp"

#include <gmock/gmock.h>

namespace rds::tracker::prediction {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(PredictionConfig, ReadsWhatIsGivenAndKeepsTheOtherDefaults) {
  config::ConfigReader reader(
      YAML::Load("{algorithm: paper}"), "test.yaml");
  PredictionConfig config;
  read(reader, config);
  reader.finish();
  EXPECT_EQ(config.algorithm, "paper");
  EXPECT_EQ(config.min_score, PredictionConfig().min_score);
  EXPECT_TRUE(config.labels["person"].movable);
  EXPECT_FALSE(config.labels["chair"].movable);
}

TEST(PredictionConfig, NamesEveryViolation) {
  config::ConfigReader reader(
      YAML::Load("{algorithm: magic, min_score: 2, margin: 3}"), "test.yaml");
  PredictionConfig config;
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("algorithm: magic"), HasSubstr("min_score: 2"),
                                HasSubstr("margin: unknown key")));
  }
}

}  // namespace
}  // namespace rds::tracker::prediction
