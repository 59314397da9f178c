// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/dead_reckoning.hpp"

#include <gtest/gtest.h>

namespace rds::simulator {
namespace {

constexpr DeadReckoningErrors kNone{.scale = 1, .way_noise = 0, .turn_noise_rad = 0, .slips_per_second = 0};

/// Straight ahead at half a metre a second, 50 poses a second.
std::vector<geometry::StampedPose> straight(double seconds) {
  std::vector<geometry::StampedPose> path;
  for (int i = 0; i <= static_cast<int>(50 * seconds); ++i)
    path.push_back({std::int64_t{i} * 20'000'000,
                    geometry::make_pose({2, 0.01 * i, 1}, Eigen::Quaterniond::Identity()), ""});
  return path;
}

double way_m(const std::vector<geometry::StampedPose>& told) {
  return told.back().map_from_camera.translation().norm();
}

TEST(DeadReckoning, WithoutErrorsIsTheTruthFromTheFirstCameraOn) {
  const auto truth = straight(4);
  const auto told = dead_reckoning(truth, kNone, 1);
  ASSERT_EQ(told.size(), truth.size());
  EXPECT_TRUE(told.front().map_from_camera.isApprox(geometry::Pose::Identity()));
  EXPECT_TRUE(told.back().map_from_camera.isApprox(
      truth.front().map_from_camera.inverse() * truth.back().map_from_camera, 1e-9));
  EXPECT_EQ(told.back().stamp_ns, truth.back().stamp_ns);
}

TEST(DeadReckoning, TellsAScaledWay) {
  DeadReckoningErrors errors = kNone;
  errors.scale = 1.05;
  EXPECT_NEAR(way_m(dead_reckoning(straight(4), errors, 1)), 1.05 * 2, 1e-9);
}

TEST(DeadReckoning, TellsMoreWhereItSlips) {
  DeadReckoningErrors errors = kNone;
  errors.slips_per_second = 0.25;
  const double told_m = way_m(dead_reckoning(straight(60), errors, 1));
  EXPECT_GT(told_m, 30 * 1.005);
  EXPECT_LT(told_m, 30 * 1.05) << "a slip of 0.2 s every four seconds, by 0.3";
}

TEST(DeadReckoning, IsTheSameWithTheSameSeed) {
  const auto truth = straight(4);
  const auto a = dead_reckoning(truth, {}, 1);
  EXPECT_TRUE(a.back().map_from_camera.matrix() ==
              dead_reckoning(truth, {}, 1).back().map_from_camera.matrix());
  EXPECT_FALSE(a.back().map_from_camera.matrix() ==
               dead_reckoning(truth, {}, 2).back().map_from_camera.matrix());
}

}  // namespace
}  // namespace rds::simulator
