// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/trajectory_plot.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/temporary_folder.hpp"

namespace rds::evaluation {
namespace {
using geometry::StampedPose;

std::vector<StampedPose> circle(double radius) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 100; ++i)
    poses.push_back({i * 33'000'000LL,
                     geometry::make_pose({radius * std::cos(0.06 * i), 0, radius * std::sin(0.06 * i)},
                                         Eigen::Quaterniond::Identity()),
                     ""});
  return poses;
}

int pixels_of_color(const cv::Mat& picture, const cv::Rect& area, const cv::Scalar& color) {
  cv::Mat mask;
  cv::inRange(picture(area), color, color, mask);
  return cv::countNonZero(mask);
}
const cv::Rect kLeft(0, 110, 620, 550);
const cv::Rect kRight(620, 110, 620, 550);

TEST(TrajectoryPlot, ShowsBothPathsAndTheError) {
  const auto truth = circle(1);
  const auto estimate = circle(1.05);
  const auto plot = draw_trajectory_plot({truth, estimate, "t"});
  EXPECT_GT(pixels_of_color(plot, kLeft, {190, 95, 20}), 500);
  EXPECT_GT(pixels_of_color(plot, kLeft, {150, 150, 150}), 200);
  EXPECT_GT(pixels_of_color(plot, kRight, {40, 40, 200}), 200);
}

TEST(TrajectoryPlot, WorksWithoutTruthAndWithoutAnything) {
  const auto estimate = circle(1);
  const auto plot = draw_trajectory_plot({{}, estimate, "t"});
  EXPECT_GT(pixels_of_color(plot, kLeft, {190, 95, 20}), 500);
  EXPECT_EQ(pixels_of_color(plot, kLeft, {150, 150, 150}), 0);
  EXPECT_GT(pixels_of_color(plot, kRight, {60, 140, 40}), 100);
  EXPECT_FALSE(draw_trajectory_plot({{}, {}, ""}).empty());
  const std::vector<StampedPose> one{estimate.front()};
  EXPECT_FALSE(draw_trajectory_plot({one, one, ""}).empty());
}

TEST(TrajectoryPlot, WritesAPictureOrSaysWhy) {
  const test::TemporaryFolder folder;
  const auto estimate = circle(1);
  ASSERT_TRUE(write_trajectory_plot(folder / "plot.png", {{}, estimate, "t"}));
  EXPECT_EQ(cv::imread((folder / "plot.png").string()).size(), cv::Size(1240, 660));
  EXPECT_THAT(write_trajectory_plot("/nowhere/plot.png", {{}, estimate, "t"}).error(),
              testing::HasSubstr("/nowhere/plot.png"));
  EXPECT_FALSE(write_trajectory_plot(folder / "plot.strange", {{}, estimate, "t"}));
}

}  // namespace
}  // namespace rds::evaluation
