// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/planes.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

KeyframeRecord record_of(const KeyframeInput& input) {
  return test::measured(input);
}

/// A wall at 3 m as structured light measures it: noise of z² × 0.003 / m, every tenth pixel missing.
KeyframeInput noisy_wall() {
  auto input = test::SyntheticKeyframe(0).make();
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 0.027F);
  for (auto& depth : cv::Mat1f(input.depth.values)) depth = random() % 10 == 0 ? 0 : depth + noise(random);
  return input;
}

TEST(Planes, AWallIsFoundInANoisyPictureWithHoles) {
  const auto planes = find_planes(record_of(noisy_wall()), geometry::kDepthNoises.front());
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_GT(std::abs(planes[0].plane.normal.z()), 0.999);
  EXPECT_NEAR(std::abs(planes[0].plane.offset_m), 3.0, 0.01);
  EXPECT_GT(planes[0].pixels.size(), 0.8 * 160 * 120);
}

TEST(Planes, PartsOfAWallBesideSomebodyAreOnePlane) {
  auto input = test::SyntheticKeyframe(0).rectangle({130, 0, 60, 240}, 1.5).make();
  const auto planes = find_planes(record_of(input), geometry::kDepthNoises.front());
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_NEAR(std::abs(planes[0].plane.offset_m), 3.0, 0.01);
  EXPECT_TRUE(std::ranges::any_of(planes[0].pixels, [](std::size_t i) { return i % 160 < 50; }));
  EXPECT_TRUE(std::ranges::any_of(planes[0].pixels, [](std::size_t i) { return i % 160 > 110; }));
}

TEST(Planes, ACurvedSurfaceIsNone) {
  auto input = test::SyntheticKeyframe(0).make();
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x)
      input.depth.values.at<float>(y, x) =
          static_cast<float>(2 - 0.5 * std::cos((x - 160) / 15.0) * std::cos((y - 120) / 15.0));
  EXPECT_TRUE(find_planes(record_of(input), geometry::kDepthNoises.front()).empty());
}

}  // namespace
}  // namespace rds::mapper
