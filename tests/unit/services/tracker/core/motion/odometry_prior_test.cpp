// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/odometry_prior.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/motion/driven_robot.hpp"

namespace rds::tracker {
namespace {

using geometry::Pose;
using test::DrivenRobot;

constexpr int kSecond = 30;  // frames

/// A camera that sees where it is to some millimetres, beside its odometry.
class Driven {
 public:
  explicit Driven(std::function<Twist(const Twist&, int)> told)
      : robot_(std::move(told)), prior_(robot_.odometry()) {}

  void see(int frames) {
    for (int i = 0; i < frames; ++i) {
      prior_.go_to(DrivenRobot::stamp_ns(++frame_));
      const Pose seen = robot_.truth(frame_) * se3_exp(noise());
      if (prior_.observe(begin_.inverse() * seen)) begin_ = seen;
    }
  }
  void cover(int frames) {
    for (int i = 0; i < frames; ++i) prior_.go_to(DrivenRobot::stamp_ns(++frame_));
  }
  /// Of the camera that was carried on: nullopt if it was not.
  [[nodiscard]] std::optional<Twist> error() const {
    const auto motion = prior_.since_begin();
    if (!motion) return std::nullopt;
    return se3_log((begin_ * motion->begin_from_camera).inverse() * robot_.truth(frame_));
  }
  [[nodiscard]] const OdometryPrior& prior() const { return prior_; }

 private:
  Twist noise() {
    Twist twist;
    for (int i = 0; i < 6; ++i) twist[i] = 0.002 * normal_(random_);
    return twist;
  }

  DrivenRobot robot_;
  OdometryPrior prior_;
  int frame_ = 0;
  Pose begin_ = Pose::Identity();
  std::mt19937 random_{5};
  std::normal_distribution<double> normal_;
};

Twist five_percent_too_far(const Twist& step, int /*frame*/) {
  return 1.05 * step;
}

/// Besides, every third second the wheels turn a third further than they roll, for 0.2 s.
Twist slipping(const Twist& step, int frame) {
  return (frame % (3 * kSecond) < 6 ? 1.33 * 1.05 : 1.05) * step;
}

TEST(OdometryPrior, LearnsTheScaleAndCarriesOnWithinCentimetres) {
  Driven robot(five_percent_too_far);
  robot.see(10 * kSecond);
  ASSERT_TRUE(robot.prior().is_trusted());
  EXPECT_NEAR(robot.prior().scale()[0], 1 / 1.05, 0.01);
  EXPECT_NEAR(robot.prior().scale()[1], 1 / 1.05, 0.01);
  robot.cover(3 * kSecond);
  ASSERT_TRUE(robot.error());
  EXPECT_LT(robot.error()->head<3>().norm(), 0.03);
  EXPECT_LT(robot.error()->tail<3>().norm(), 0.03);
}

TEST(OdometryPrior, CarriesOnBesideSlip) {
  Driven robot(slipping);
  robot.see(10 * kSecond);
  robot.cover(3 * kSecond);
  ASSERT_TRUE(robot.error());
  EXPECT_LT(robot.error()->head<3>().norm(), 0.03);
}

TEST(OdometryPrior, SaysHowFarTheCarriedPoseIsKnown) {
  Driven robot(slipping);
  robot.see(10 * kSecond);
  double before_m = 0;
  for (int i = 0; i < 8; ++i) {
    robot.cover(kSecond / 2);
    const auto motion = robot.prior().since_begin();
    if (!motion) break;
    const double sigma_m = std::sqrt(motion->covariance.diagonal().head<3>().maxCoeff());
    EXPECT_GT(sigma_m, before_m);
    before_m = sigma_m;
    EXPECT_LT(robot.error()->dot(motion->covariance.ldlt().solve(*robot.error())), 22.46) << i;
  }
  EXPECT_GT(before_m, 0.02);
}

TEST(OdometryPrior, StopsWhereTheWayIsAGuess) {
  Driven robot(five_percent_too_far);
  robot.see(10 * kSecond);
  robot.cover(120 * kSecond);
  EXPECT_TRUE(robot.prior().is_trusted());
  EXPECT_FALSE(robot.error());
}

TEST(OdometryPrior, TrustsNoneThatIsNew) {
  Driven robot(five_percent_too_far);
  robot.see(kSecond);
  EXPECT_FALSE(robot.prior().is_trusted());
  robot.cover(1);
  EXPECT_FALSE(robot.error());
}

/// Odometry that has nothing to do with the robot's motion.
class WrongOdometry : public ::testing::TestWithParam<std::function<Twist(const Twist&, int)>> {};

TEST_P(WrongOdometry, IsNeverTrusted) {
  Driven robot(GetParam());
  for (int i = 0; i < 60; ++i) {
    robot.see(kSecond);
    EXPECT_FALSE(robot.prior().is_trusted()) << i;
  }
}

Twist frozen(const Twist& /*step*/, int /*frame*/) {
  return Twist::Zero();
}

Twist quarter_turned(const Twist& step, int /*frame*/) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Twist turned;
  turned << turn * step.head<3>(), step.tail<3>();
  return turned;
}

Twist random_walk(const Twist& /*step*/, int frame) {
  std::mt19937 random(static_cast<unsigned>(frame));
  std::normal_distribution<double> normal;
  Twist step;
  for (int i = 0; i < 6; ++i) step[i] = 0.01 * normal(random);
  return step;
}

INSTANTIATE_TEST_SUITE_P(Of, WrongOdometry, ::testing::Values(frozen, quarter_turned, random_walk));

TEST(OdometryPrior, IsTrustedNoMoreWhenItsWheelsStandStill) {
  Driven robot([](const Twist& step, int frame) {
    return frame < 10 * kSecond ? Twist(1.05 * step) : Twist(Twist::Zero());
  });
  robot.see(10 * kSecond - 1);
  ASSERT_TRUE(robot.prior().is_trusted());
  robot.see(2 * kSecond);
  EXPECT_FALSE(robot.prior().is_trusted());
}

TEST(OdometryPrior, LearnsAnotherScale) {
  Driven robot(
      [](const Twist& step, int frame) { return Twist((frame < 10 * kSecond ? 1.05 : 0.8) * step); });
  robot.see(25 * kSecond);
  EXPECT_TRUE(robot.prior().is_trusted());
  EXPECT_NEAR(robot.prior().scale()[0], 1.25, 0.03);
}

TEST(OdometryPrior, SaysNothingWithoutOdometry) {
  OdometryPrior prior({});
  prior.go_to(0);
  EXPECT_FALSE(prior.observe(Pose::Identity()));
  prior.go_to(1);
  EXPECT_FALSE(prior.since_begin());
}

}  // namespace
}  // namespace rds::tracker
