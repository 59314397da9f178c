// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/frame_look.hpp"

#include <cstdint>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace rds::doctor {
namespace {

cv::Mat squares() {
  cv::Mat gray(120, 160, CV_8UC1);
  for (int y = 0; y < gray.rows; ++y)
    for (int x = 0; x < gray.cols; ++x) gray.at<std::uint8_t>(y, x) = (x / 20 + y / 20) % 2 == 0 ? 50 : 150;
  return gray;
}

image::DepthImage depth_of(const cv::Mat& values) {
  return {values, 0.001F, nullptr};
}

TEST(LookAtColor, MeasuresBrightnessAndContrast) {
  const auto look = look_at_color(squares());
  EXPECT_NEAR(look.brightness, 100, 0.1);
  EXPECT_NEAR(look.contrast, 50, 0.1);
}

TEST(LookAtColor, SharpnessFallsWithBlurAndNotWithContrast) {
  const double sharp = look_at_color(squares()).sharpness;
  cv::Mat blurred;
  cv::GaussianBlur(squares(), blurred, {}, 3);
  EXPECT_LT(look_at_color(blurred).sharpness, 0.1 * sharp);
  EXPECT_NEAR(look_at_color(squares() / 2).sharpness, sharp, 0.01 * sharp);
  EXPECT_EQ(look_at_color(cv::Mat(20, 20, CV_8UC1, cv::Scalar(80))).sharpness, 0);
}

TEST(LookAtColor, SharpnessIsThatOfTheScene) {
  cv::Mat usual;
  cv::Mat large;
  cv::resize(squares(), usual, {}, 4, 4, cv::INTER_LINEAR);
  cv::resize(squares(), large, {}, 8, 8, cv::INTER_LINEAR);
  EXPECT_NEAR(look_at_color(large).sharpness / look_at_color(usual).sharpness, 1, 0.2);
}

TEST(LookAtDepth, MeasuresTheRangeOfWhatIsMeasured) {
  cv::Mat values(40, 400, CV_16UC1, cv::Scalar(0));
  for (int x = 0; x < 400; ++x) values.rowRange(0, 20).col(x) = 1000 + 5 * x;
  const auto look = look_at_depth(depth_of(values));
  EXPECT_NEAR(look.measured, 0.5, 1e-9);
  EXPECT_NEAR(look.near_m, 1.0, 0.05);
  EXPECT_NEAR(look.median_m, 2.0, 0.05);
  EXPECT_NEAR(look.far_m, 3.0, 0.05);
  EXPECT_NEAR(look.commonest, 0.01, 1e-9);
}

TEST(LookAtDepth, FindsTheCommonestRawValue) {
  cv::Mat values(40, 40, CV_16UC1, cv::Scalar(1500));
  values.rowRange(0, 28) = 65535;
  const auto look = look_at_depth(depth_of(values));
  EXPECT_EQ(look.commonest_raw, 65535);
  EXPECT_NEAR(look.commonest, 0.7, 1e-9);
}

TEST(LookAtDepth, OfNoMeasurementIsAllZero) {
  const auto look = look_at_depth(depth_of(cv::Mat(20, 20, CV_16UC1, cv::Scalar(0))));
  EXPECT_EQ(look.measured, 0);
  EXPECT_EQ(look.median_m, 0);
}

}  // namespace
}  // namespace rds::doctor
