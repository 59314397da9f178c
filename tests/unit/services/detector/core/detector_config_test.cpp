// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/detector_config.hpp"

#include <gmock/gmock.h>

namespace rds::detector {
namespace {

TEST(DetectorConfig, ShippedYamlSaysTheDefaults) {
  auto reader = config::ConfigReader::from_file(RDS_SOURCE_DIR "/services/detector/detector.yaml");
  DetectorConfig shipped;
  shipped.network = "changed by the file";
  shipped.threads = 7;
  shipped.score_threshold = .5;
  shipped.other_label_iou = .5;
  shipped.max_boxes = 7;
  shipped.depth = {.5, 1, 1, 1, 1};
  read(reader, shipped);
  const DetectorConfig defaults;
  EXPECT_EQ(shipped.network, defaults.network);
  EXPECT_EQ(shipped.threads, defaults.threads);
  EXPECT_EQ(shipped.score_threshold, defaults.score_threshold);
  EXPECT_EQ(shipped.other_label_iou, defaults.other_label_iou);
  EXPECT_EQ(shipped.max_boxes, defaults.max_boxes);
  EXPECT_EQ(shipped.depth.central_part, defaults.depth.central_part);
  EXPECT_EQ(shipped.depth.object_extent_m, defaults.depth.object_extent_m);
  EXPECT_EQ(shipped.depth.nearer_surface, defaults.depth.nearer_surface);
  EXPECT_EQ(shipped.depth.min_valid, defaults.depth.min_valid);
  EXPECT_EQ(shipped.depth.max_depth_m, defaults.depth.max_depth_m);
}

TEST(DetectorConfig, NamesValuesOutOfRange) {
  config::ConfigReader reader(YAML::Load("{threads: 0, depth: {central_part: 2}}"), "detector.yaml");
  DetectorConfig config;
  read(reader, config);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(e.what(), ::testing::AllOf(::testing::HasSubstr("threads: 0, expected 1 … 64"),
                                           ::testing::HasSubstr("depth.central_part: 2")));
  }
}

}  // namespace
}  // namespace rds::detector
