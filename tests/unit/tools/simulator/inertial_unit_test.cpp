// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensors/inertial_unit.hpp"

#include <gtest/gtest.h>

namespace rds::simulator {
namespace {

constexpr double kGravity = 9.81;
const InertialErrors kNone{
    {.noise = 0, .bias_rad_per_s = 0, .bias_walk = 0, .scale = 0, .delay_ns = 0}, 0, 0};

/// Two seconds of a camera that looks ahead on a circle of one metre, 1 rad/s about the world's z axis.
std::vector<geometry::StampedPose> circling() {
  const Eigen::Quaterniond ahead(-0.5, 0.5, -0.5, 0.5);  // x right, y down, z forward
  std::vector<geometry::StampedPose> truth;
  for (int i = 0; i <= 800; ++i) {
    const double angle = i / 400.0;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    truth.push_back({1'000'000'000 + i * 2'500'000LL,
                     geometry::make_pose({std::sin(angle), -std::cos(angle), 0}, turn * ahead), ""});
  }
  return truth;
}

TEST(InertialUnit, TellsOfGravityAndOfTheTurnInTheCamerasAxes) {
  const auto track = inertial_unit(circling(), kNone, 1);
  EXPECT_TRUE(track.has_gyroscope);
  EXPECT_NEAR(static_cast<double>(track.measurements.size()), 400, 2);
  // Ahead is the tangent, so the centre is to the left, and up is −y.
  for (const auto& m : track.measurements) {
    EXPECT_LT((m.acceleration - Eigen::Vector3d(-1, -kGravity, 0)).norm(), 1e-3);
    EXPECT_LT((m.turn_rate - Eigen::Vector3d(0, -1, 0)).norm(), 1e-3);
  }
}

TEST(InertialUnit, ErrsTheSameForTheSameSeed) {
  const auto once = inertial_unit(circling(), {}, 7);
  const auto again = inertial_unit(circling(), {}, 7);
  const auto other = inertial_unit(circling(), {}, 8);
  ASSERT_EQ(once.measurements.size(), again.measurements.size());
  double squares = 0;
  for (std::size_t i = 0; i < once.measurements.size(); ++i) {
    EXPECT_EQ(once.measurements[i].acceleration, again.measurements[i].acceleration);
    squares += (once.measurements[i].acceleration - Eigen::Vector3d(-1, -kGravity, 0)).squaredNorm();
  }
  const double rms = std::sqrt(squares / static_cast<double>(once.measurements.size()));
  EXPECT_GT(rms, 0.02);
  EXPECT_LT(rms, 0.3) << "bias and noise";
  EXPECT_NE(once.measurements[0].acceleration, other.measurements[0].acceleration);
}

}  // namespace
}  // namespace rds::simulator
