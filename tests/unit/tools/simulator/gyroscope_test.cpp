// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/gyroscope.hpp"

#include <gtest/gtest.h>

namespace rds::simulator {
namespace {

/// Ten seconds of a camera that turns about its y axis at 0.5 rad/s.
std::vector<geometry::StampedPose> turning() {
  std::vector<geometry::StampedPose> truth;
  for (int i = 0; i <= 300; ++i)
    truth.push_back(
        {1'000'000'000 + i * 33'333'333LL,
         geometry::make_pose(Eigen::Vector3d::Zero(),
                             Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * i / 30.0, Eigen::Vector3d::UnitY()))),
         ""});
  return truth;
}

Eigen::Vector3d mean_of(const std::vector<TurnRate>& told) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const TurnRate& rate : told) sum += rate.rad_per_s;
  return sum / static_cast<double>(told.size());
}

TEST(Gyroscope, TellsTheTurnsOfAPathWithoutErrors) {
  const auto told =
      gyroscope(turning(), {.noise = 0, .bias_rad_per_s = 0, .bias_walk = 0, .scale = 0, .delay_ns = 0}, 1);
  EXPECT_NEAR(static_cast<double>(told.size()), 2000, 2);
  EXPECT_EQ(told[1].stamp_ns - told[0].stamp_ns, 5'000'000);
  for (std::size_t i = 1; i < told.size(); ++i)
    EXPECT_LT((told[i].rad_per_s - Eigen::Vector3d(0, 0.5, 0)).norm(), 1e-3) << i;
}

TEST(Gyroscope, ErrsAsAConsumersChip) {
  const auto told = gyroscope(turning(), {}, 1);
  const double off = (mean_of(told) - Eigen::Vector3d(0, 0.5, 0)).norm();
  EXPECT_GT(off, 0.002);
  EXPECT_LT(off, 0.08) << "three standard deviations of the bias";
  double variance = 0;
  for (std::size_t i = 2; i < told.size(); ++i)  // before the first pose it stood still
    variance += (told[i].rad_per_s - told[i - 1].rad_per_s).squaredNorm() / 6;
  EXPECT_NEAR(std::sqrt(variance / static_cast<double>(told.size())), 2.4e-4 * std::sqrt(200), 5e-4);
  EXPECT_EQ(told[0].stamp_ns, 1'003'000'000) << "late";
}

TEST(Gyroscope, IsTheSameForTheSameSeed) {
  const auto once = gyroscope(turning(), {}, 7);
  const auto again = gyroscope(turning(), {}, 7);
  const auto other = gyroscope(turning(), {}, 8);
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i].rad_per_s, again[i].rad_per_s);
  EXPECT_NE(once[5].rad_per_s, other[5].rad_per_s);
  EXPECT_TRUE(gyroscope({}, {}, 1).empty());
}

}  // namespace
}  // namespace rds::simulator
