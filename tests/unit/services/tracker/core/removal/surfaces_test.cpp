// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/removal/surfaces.hpp"

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

/// Two surfaces, 1 m and 2 m away; the left half is the nearer one.
cv::Mat1f step() {
  cv::Mat1f depth(10, 20, 2.0F);
  depth(cv::Rect(0, 0, 10, 10)).setTo(1);
  return depth;
}

TEST(Surfaces, StopsAtAStepInDepth) {
  cv::Mat1b mask(10, 20, std::uint8_t{0});
  mask(5, 5) = 255;
  grow_surface(step(), {{0, 0, 20, 10}, 0, 9, 0.05}, {{5, 5}}, mask);
  EXPECT_EQ(cv::countNonZero(mask), 100);
  EXPECT_EQ(mask(5, 10), 0);
}

TEST(Surfaces, StaysWithinItsLimits) {
  cv::Mat1b mask(10, 20, std::uint8_t{0});
  grow_surface(step(), {{3, 3, 10, 4}, 0, 1.5F, 0.05}, {{5, 5}}, mask);
  EXPECT_EQ(cv::countNonZero(mask), 7 * 4);
}

TEST(Surfaces, FollowsASlope) {
  cv::Mat1f depth(1, 40);
  for (int c = 0; c < 40; ++c) depth(0, c) = 1 + 0.04F * static_cast<float>(c);
  cv::Mat1b mask(1, 40, std::uint8_t{0});
  grow_surface(depth, {{0, 0, 40, 1}, 0, 9, 0.05}, {{0, 0}}, mask);
  EXPECT_EQ(cv::countNonZero(mask), 40);
}

TEST(Surfaces, FindsSurfacesTheLargestFirst) {
  cv::Mat1f depth = step();
  depth(cv::Rect(15, 0, 5, 10)).setTo(0);
  const auto surfaces = surfaces_within(depth, {{0, 0, 20, 10}, 0, 9, 0.05});
  ASSERT_EQ(surfaces.size(), 2U);
  EXPECT_EQ(surfaces[0].size(), 100U);
  EXPECT_EQ(surfaces[1].size(), 50U);
}

}  // namespace
}  // namespace rds::tracker
