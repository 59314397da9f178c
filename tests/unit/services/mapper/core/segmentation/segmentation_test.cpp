// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/segmentation.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

KeyframeRecord record_of(const KeyframeInput& input) {
  const SamplingConfig config;
  return test::measured(input, config);
}

/// A wall with a rounded object 40 cm before it (a plane of its own would be no object).
KeyframeInput wall_and_ball() {
  auto input = test::SyntheticKeyframe(0).make();
  for (int y = 80; y < 160; ++y)
    for (int x = 120; x < 200; ++x) {
      const double r2 = (x - 160) * (x - 160) + (y - 120) * (y - 120);
      if (r2 < 1600)
        input.depth.values.at<float>(y, x) = static_cast<float>(2.6 - 0.25 * std::sqrt(1 - r2 / 1600));
    }
  return input;
}

TEST(Segmentation, TakesTheWallAwayAndFindsTheObjectBeforeIt) {
  const auto record = record_of(wall_and_ball());
  MapperConfig config;
  config.segmentation.stride = 1;
  const auto segments = segment(record, config);
  ASSERT_EQ(segments.size(), 2U);
  ASSERT_TRUE(segments[0].plane);
  EXPECT_NEAR(std::abs(segments[0].plane->offset_m), 3.0, 0.01);
  const auto& ball = segments[1];
  EXPECT_FALSE(ball.plane);
  EXPECT_GT(geometry::iou(ball.box_px, {120, 80, 200, 160}), 0.7);
  for (const auto i : ball.pixels) EXPECT_LT(record.depth_m(i), 2.7F);
}

TEST(Segmentation, NothingMeasuredGivesNothing) {
  EXPECT_TRUE(segment(record_of(test::SyntheticKeyframe(0, 0.0).make()), MapperConfig{}).empty());
}

}  // namespace
}  // namespace rds::mapper
