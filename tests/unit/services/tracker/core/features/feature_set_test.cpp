// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/features/feature_set.hpp"

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

constexpr double kFar = 8;  // m

/// Two metres away everywhere, in millimetres.
image::DepthImage wall() {
  image::DepthImage depth;
  depth.values = cv::Mat(20, 20, CV_16UC1, cv::Scalar(2000));
  return depth;
}

/// The same with another depth [mm] at one pixel.
image::DepthImage wall_with(int x, int y, int depth_mm) {
  image::DepthImage depth = wall();
  depth.values.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(depth_mm);
  return depth;
}

TEST(DepthAt, IsThatOfTheNearestPixel) {
  EXPECT_FLOAT_EQ(depth_at(wall_with(5, 7, 2010), {5.4F, 6.6F}, kFar), 2.01F);
}

TEST(DepthAt, AtAnEdgeIsThatOfTheSurfaceInFront) {
  image::DepthImage depth = wall();
  depth.values.colRange(0, 10).setTo(1500);
  EXPECT_FLOAT_EQ(depth_at(depth, {9, 10}, kFar), 1.5F);
  EXPECT_FLOAT_EQ(depth_at(depth, {10, 10}, kFar), 1.5F);
  EXPECT_FLOAT_EQ(depth_at(depth, {11, 10}, kFar), 2.0F);
}

TEST(DepthAt, NoiseIsNoEdge) {
  EXPECT_FLOAT_EQ(depth_at(wall_with(9, 10, 1960), {10, 10}, kFar), 2.0F);
}

TEST(DepthAt, IsZeroWithoutMeasurementOrTooFarAway) {
  const image::DepthImage depth = wall_with(10, 10, 0);
  EXPECT_EQ(depth_at(depth, {10, 10}, kFar), 0);
  EXPECT_EQ(depth_at(depth, {3, 3}, 1.9), 0);
}

TEST(DepthAt, WorksInTheCorner) {
  EXPECT_FLOAT_EQ(depth_at(wall(), {-0.4F, 19.4F}, kFar), 2.0F);
}

}  // namespace
}  // namespace rds::tracker
