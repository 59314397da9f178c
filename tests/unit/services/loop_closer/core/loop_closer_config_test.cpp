// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_closer_config.hpp"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

namespace rds::loop_closer {
namespace {

TEST(LoopCloserConfig, ShippedFileHoldsTheDefaultsAndNothingElse) {
  LoopCloserConfig shipped;
  // Values that differ from the defaults, so that a key missing from the file would show.
  shipped.max_features = 51;
  shipped.place_index = {1, 1};
  shipped.candidates = {1, 0.5, 1, 1};
  shipped.matching = {1, 0.5};
  shipped.verification = {1, 10, 0.001, 0.001, 4, 6, 0.001, 0.9, 9};
  shipped.consistency = {1, 1, 1, 1, 1, 1, 1, 1, 1};
  shipped.pose_graph = {1, 1, 1, 1, 1, 1, 1, 1, 1};
  auto reader = config::ConfigReader::from_file(RDS_SOURCE_DIR "/services/loop_closer/loop_closer.yaml");
  read(reader, shipped);
  const LoopCloserConfig defaults;
  EXPECT_EQ(shipped.max_features, defaults.max_features);
  EXPECT_EQ(shipped.place_index, defaults.place_index);
  EXPECT_EQ(shipped.candidates, defaults.candidates);
  EXPECT_EQ(shipped.matching, defaults.matching);
  EXPECT_EQ(shipped.verification, defaults.verification);
  EXPECT_EQ(shipped.consistency, defaults.consistency);
  EXPECT_EQ(shipped.pose_graph, defaults.pose_graph);
}

TEST(LoopCloserConfig, ListsEveryValueOutOfRange) {
  LoopCloserConfig config;
  config::ConfigReader reader(
      YAML::Load("{candidates: {min_score: 2}, pose_graph: {max_iterations: 0}, typo: 1}"), "x");
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), ::testing::AllOf(::testing::HasSubstr("candidates.min_score"),
                                           ::testing::HasSubstr("pose_graph.max_iterations"),
                                           ::testing::HasSubstr("typo")));
  }
}

}  // namespace
}  // namespace rds::loop_closer
