// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/level/gravity.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

constexpr std::int64_t kStepNs = 5'000'000;  // 200 Hz
constexpr std::int64_t kEndNs = 1'000'000'000;

/// Of a unit that is tilted by 30° about x, for a second.
Gravity tilted(double shake, double turn_rate, int measurements = 200) {
  Gravity gravity;
  const Eigen::Vector3d up(0, -std::cos(std::numbers::pi / 6), -std::sin(std::numbers::pi / 6));
  for (int i = 0; i < measurements; ++i)
    gravity.add({i * kStepNs, 9.78 * up + Eigen::Vector3d(i % 2 == 0 ? shake : -shake, 0, 0),
                 Eigen::Vector3d(0, turn_rate, 0)});
  return gravity;
}

TEST(Gravity, IsTheMeanOfAUnitThatStandsStill) {
  const auto up = tilted(0.1, 0.01).up(kEndNs);
  ASSERT_TRUE(up);
  EXPECT_NEAR(up->norm(), 1, 1e-12);
  EXPECT_NEAR(up->y(), -std::cos(std::numbers::pi / 6), 1e-3);
}

TEST(Gravity, IsNotToldOfOneThatMoves) {
  EXPECT_FALSE(tilted(1, 0.01).up(kEndNs));
  EXPECT_FALSE(tilted(0.1, 0.2).up(kEndNs));
}

TEST(Gravity, IsOfThePicturesTimeThoughTheUnitHasMovedSince) {
  Gravity gravity = tilted(0, 0);
  for (int i = 200; i < 240; ++i)
    gravity.add({i * kStepNs, Eigen::Vector3d(5, 5, 5), Eigen::Vector3d::Zero()});
  EXPECT_TRUE(gravity.up(199 * kStepNs));
  EXPECT_FALSE(gravity.up(239 * kStepNs));
  EXPECT_FALSE(gravity.up(-1)) << "of another clock: the latest";
}

TEST(Gravity, IsNotToldByFewMeasurements) {
  EXPECT_FALSE(Gravity().up(kEndNs));
  EXPECT_FALSE(tilted(0, 0, 9).up(kEndNs));
  EXPECT_FALSE(tilted(0, 0, 40).up(kEndNs)) << "0.2 s";
}

TEST(Gravity, IsNotToldByAccelerationsThatAreNoGravity) {
  Gravity in_g;  // a driver that tells multiples of g
  Gravity broken;
  for (int i = 0; i < 200; ++i) {
    in_g.add({i * kStepNs, Eigen::Vector3d(0, 0, 1), Eigen::Vector3d::Zero()});
    broken.add({i * kStepNs, Eigen::Vector3d(0, 0, std::numeric_limits<double>::quiet_NaN()),
                Eigen::Vector3d::Zero()});
  }
  EXPECT_FALSE(in_g.up(kEndNs));
  EXPECT_FALSE(broken.up(kEndNs));
}

TEST(Gravity, BeginsAnewWhereStampsGoBack) {
  Gravity gravity = tilted(0, 0);
  gravity.add({0, Eigen::Vector3d(0, 0, 9.81), Eigen::Vector3d::Zero()});
  EXPECT_FALSE(gravity.up(kEndNs));
}

}  // namespace
}  // namespace rds::tracker
