// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/box_depth.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace rds::detector {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
const geometry::Box2 kPersonBox{100, 20, 200, 220};

/// A wall at 4 m, depth in mm.
cv::Mat wall() {
  return {kHeight, kWidth, CV_16UC1, cv::Scalar(4000)};
}

void paint(cv::Mat& depth, int x0, int y0, int x1, int y1, int value) {
  depth(cv::Rect(cv::Point(x0, y0), cv::Point(x1, y1))).setTo(value);
}

float depth_of(const cv::Mat& values, const geometry::Box2& box = kPersonBox) {
  return box_depth({values, 0.001F, nullptr}, box, 20.0);
}

TEST(BoxDepth, IsThatOfThePersonInFrontOfTheWall) {
  cv::Mat depth = wall();
  paint(depth, 115, 20, 185, 220, 2000);
  EXPECT_NEAR(depth_of(depth), 2.0F, 1e-4F);
}

TEST(BoxDepth, IsNotFooledByTheWallAtTheCentrePixel) {
  cv::Mat depth = wall();
  paint(depth, 105, 20, 138, 220, 2000);  // one leg
  paint(depth, 162, 20, 195, 220,
        2000);  // the other; the wall between them is more than a third of the central part
  EXPECT_EQ(depth.at<std::uint16_t>(120, 150), 4000);
  EXPECT_NEAR(depth_of(depth), 2.0F, 1e-4F);
}

TEST(BoxDepth, IgnoresASmallThingInFrontOfThePerson) {
  cv::Mat depth = wall();
  paint(depth, 110, 20, 190, 220, 2500);
  paint(depth, 120, 140, 180, 158, 800);
  EXPECT_NEAR(depth_of(depth), 2.5F, 1e-4F);
}

TEST(BoxDepth, IgnoresHoles) {
  cv::Mat depth = wall();
  paint(depth, 110, 20, 190, 220, 2000);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if ((x + y) % 3 != 0) depth.at<std::uint16_t>(y, x) = 0;
  EXPECT_NEAR(depth_of(depth), 2.0F, 1e-4F);
}

TEST(BoxDepth, LiesBetweenOneThirdQuantileAndMedianOfACurvedSurface) {
  cv::Mat depth = wall();
  for (int x = 110; x < 190; ++x) paint(depth, x, 20, x + 1, 220, 2000 + 2 * std::abs(x - 150));
  const float found = depth_of(depth);
  EXPECT_GT(found, 2.019F);
  EXPECT_LT(found, 2.031F);
}

TEST(BoxDepth, IsZeroWithoutAnyDepth) {
  EXPECT_EQ(depth_of(cv::Mat::zeros(kHeight, kWidth, CV_16UC1)), 0.0F);
}

TEST(BoxDepth, IsZeroWithTooFewDepths) {
  cv::Mat depth = cv::Mat::zeros(kHeight, kWidth, CV_16UC1);
  paint(depth, 148, 118, 152, 122, 2000);
  EXPECT_EQ(depth_of(depth), 0.0F);
}

TEST(BoxDepth, TreatsTheLargestNumberOfASensorAsNoMeasurement) {
  cv::Mat depth(kHeight, kWidth, CV_16UC1, cv::Scalar(65535));
  EXPECT_EQ(depth_of(depth), 0.0F);
  paint(depth, 110, 20, 190, 220, 2000);
  EXPECT_NEAR(depth_of(depth), 2.0F, 1e-4F);
}

TEST(BoxDepth, ReadsMetresInFloatsAndSkipsNaN) {
  cv::Mat depth(kHeight, kWidth, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  depth(cv::Rect(110, 20, 80, 150)).setTo(1.5F);
  EXPECT_NEAR(box_depth({depth, 1.0F, nullptr}, kPersonBox, 20.0), 1.5F, 1e-5F);
}

TEST(BoxDepth, UsesThePartOfTheBoxInsideThePicture) {
  cv::Mat depth = wall();
  paint(depth, 0, 0, 100, 240, 1000);
  EXPECT_NEAR(depth_of(depth, {-100, -50, 90, 300}), 1.0F, 1e-4F);
  EXPECT_EQ(depth_of(depth, {-300, -300, -100, -100}), 0.0F);
  EXPECT_EQ(depth_of(depth, {1000, 1000, 1100, 1100}), 0.0F);
}

TEST(BoxDepth, SurvivesUnusableInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double huge = std::numeric_limits<double>::max();
  EXPECT_EQ(depth_of(cv::Mat()), 0.0F);
  EXPECT_EQ(depth_of(cv::Mat::ones(kHeight, kWidth, CV_8UC3)), 0.0F);
  EXPECT_EQ(depth_of(wall(), {nan, 0, 10, 10}), 0.0F);
  EXPECT_EQ(depth_of(wall(), {-huge, -huge, huge, huge}), 0.0F);
  EXPECT_EQ(depth_of(wall(), {50, 50, 40, 60}), 0.0F);
  EXPECT_EQ(depth_of(wall(), {50, 50, 50.5, 50.5}), 0.0F);
}

}  // namespace
}  // namespace rds::detector
