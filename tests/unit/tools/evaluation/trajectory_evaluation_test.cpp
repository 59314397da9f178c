// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/trajectory_evaluation.hpp"

#include <random>

#include <gtest/gtest.h>

namespace rds::evaluation {
namespace {
using geometry::Pose;
using geometry::StampedPose;

constexpr int kPoses = 200;

std::vector<StampedPose> true_path() {
  std::vector<StampedPose> poses;
  for (int i = 0; i < kPoses; ++i) {
    const double t = i / 30.0;
    const Eigen::Vector3d turn(0.2 * std::sin(t), 0.3 * std::cos(t), 0.1);
    poses.push_back(
        {100'000'000'000 + i * 33'333'333LL,
         geometry::make_pose({std::sin(t), std::cos(1.3 * t), 0.3 * t},
                             Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized()))),
         ""});
  }
  return poses;
}

Pose elsewhere() {
  return geometry::make_pose(
      {3, -2, 1}, Eigen::Quaterniond(Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, 2, 3).normalized())));
}

TEST(EvaluateTrajectory, AnotherFrameAndALateClockAreNoError) {
  const auto truth = true_path();
  auto estimate = truth;
  for (auto& pose : estimate) pose = {pose.stamp_ns + 4'000'000, elsewhere() * pose.map_from_camera, ""};
  const auto errors = evaluate_trajectory(truth, estimate);
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->pairs.size(), truth.size());
  EXPECT_LT(errors->absolute_m.max, 1e-9);
  EXPECT_LT(errors->relative->translation_m.max, 1e-9);
  EXPECT_LT(errors->relative->rotation_deg.max, 1e-4);
  EXPECT_NEAR(errors->similarity_scale, 1, 1e-9);
  EXPECT_TRUE(errors->truth_from_estimate.isApprox(elsewhere().inverse(), 1e-9));
}

TEST(EvaluateTrajectory, FindsTheNoiseThatWasAdded) {
  const auto truth = true_path();
  auto estimate = truth;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.05);
  double squares = 0;
  for (auto& pose : estimate) {
    const Eigen::Vector3d off(noise(random), noise(random), noise(random));
    squares += off.squaredNorm();
    pose.map_from_camera.pretranslate(off);
  }
  const double expected = std::sqrt(squares / kPoses);
  EXPECT_NEAR(evaluate_trajectory(truth, estimate)->absolute_m.rmse, expected, 0.05 * expected);
}

TEST(EvaluateTrajectory, NeverFitsScaleAway) {
  const auto truth = true_path();
  auto estimate = truth;
  for (auto& pose : estimate) pose.map_from_camera.translation() *= 2;
  const auto errors = evaluate_trajectory(truth, estimate);
  EXPECT_NEAR(errors->similarity_scale, 0.5, 1e-6);
  EXPECT_GT(errors->absolute_m.rmse, 0.1);
}

TEST(EvaluateTrajectory, RelativeErrorIsTheDriftPerSecond) {
  const auto truth = true_path();
  auto estimate = truth;
  for (std::size_t i = 0; i < estimate.size(); ++i)
    estimate[i].map_from_camera.translation().x() += 0.1 * static_cast<double>(i) / 30.0;
  EXPECT_NEAR(evaluate_trajectory(truth, estimate)->relative->translation_m.median, 0.1, 2e-3);
}

TEST(EvaluateTrajectory, NeedsThreePairs) {
  const auto truth = true_path();
  EXPECT_FALSE(evaluate_trajectory(truth, std::span(truth).first(2)));
  EXPECT_FALSE(evaluate_trajectory(truth, {}));
  const auto short_one = evaluate_trajectory(truth, std::span(truth).first(3));
  ASSERT_TRUE(short_one);
  EXPECT_FALSE(short_one->relative);
}

}  // namespace
}  // namespace rds::evaluation
