// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/loops/returns.hpp"

#include <gtest/gtest.h>

namespace rds::evaluation {
namespace {

/// Poses a second apart along x, each with the given offset to the side.
std::vector<geometry::StampedPose> walk(const std::vector<double>& x, const std::vector<double>& y = {}) {
  std::vector<geometry::StampedPose> poses;
  for (std::size_t i = 0; i < x.size(); ++i)
    poses.push_back({static_cast<std::int64_t>(i) * 1'000'000'000,
                     geometry::make_pose({x[i], y.empty() ? 0 : y[i], 0}, Eigen::Quaterniond::Identity()),
                     {}});
  return poses;
}

const std::vector<double> kThereAndBack{0, 1.5, 3, 4.5, 3, 1.5, 0};

TEST(Returns, WhoOnlyGoesForwardDoesNotReturn) {
  const auto poses = walk({0, 1.5, 3, 4.5});
  EXPECT_EQ(score_returns(poses, poses).returned, 0U);
  EXPECT_EQ(score_returns(poses, poses).missed_share(), 0);
}

TEST(Returns, WhoStaysNearHasNotBeenAway) {
  const auto poses = walk({0, 0.5, 1, 0.5, 0});
  EXPECT_EQ(score_returns(poses, poses).returned, 0U);
}

TEST(Returns, AKeyframeNearAnEarlierStayReturns) {
  const auto truth = walk(kThereAndBack);
  const ReturnScore score = score_returns(truth, truth);
  EXPECT_EQ(score.returned, 2U);  // at 1.5 and 0; at 3 the camera was only 1.5 m away
  EXPECT_EQ(score.missed, 0U);
}

TEST(Returns, WhatDriftedWithoutALoopIsMissed) {
  const auto truth = walk(kThereAndBack);
  const auto drifted = walk(kThereAndBack, {0, 0, 0, 0, 0.1, 0.1, 0.3});
  const ReturnScore score = score_returns(drifted, truth);
  EXPECT_EQ(score.returned, 2U);
  EXPECT_EQ(score.missed, 1U);
  EXPECT_DOUBLE_EQ(score.missed_share(), 0.5);
}

TEST(Returns, TheFrameOfTheMapDoesNotMatter) {
  const auto truth = walk(kThereAndBack);
  auto turned = truth;
  const geometry::Pose map_from_truth = geometry::make_pose({5, 1, 0}, Eigen::Quaterniond(0, 0, 1, 0));
  for (auto& pose : turned) pose.map_from_camera = map_from_truth * pose.map_from_camera;
  EXPECT_EQ(score_returns(turned, truth).missed, 0U);
}

}  // namespace
}  // namespace rds::evaluation
