// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/odometry/twist_filter.hpp"

#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

using geometry::Pose;

constexpr std::int64_t kFrameNs = 33'000'000;
constexpr double kFrameS = 0.033;

Twist twist_of(double forward, double turn) {
  Twist twist;
  twist << forward, 0.1, 0, 0, turn, 0;
  return twist;
}

Twist noise_of(double sigma, std::mt19937& random) {
  std::normal_distribution<double> normal(0, sigma);
  Twist noise;
  for (int i = 0; i < 6; ++i) noise[i] = normal(random);
  return noise;
}

TEST(TwistFilter, FindsASteadySpeedInTheBodysFrame) {
  TwistFilter filter;
  Pose pose = Pose::Identity();
  for (int i = 0; i < 60; ++i) {
    filter.step(i * kFrameNs, pose, 1e-8 * Matrix6::Identity());
    pose = pose * se3_exp(kFrameS * twist_of(0.5, 0.4));
  }
  EXPECT_TRUE(filter.twist().isApprox(twist_of(0.5, 0.4), 1e-4)) << filter.twist().transpose();
}

TEST(TwistFilter, KnowsNothingBeforeTheSecondPoseAndAfterAGap) {
  TwistFilter filter;
  EXPECT_GT(filter.covariance()(0, 0), 0.5);
  const Matrix6 noise = 1e-6 * Matrix6::Identity();
  for (int i = 0; i < 10; ++i) filter.step(i * kFrameNs, se3_exp(kFrameS * i * twist_of(0.5, 0)), noise);
  EXPECT_LT(filter.covariance()(0, 0), 0.01);
  filter.step(10 * kFrameNs + 1'100'000'000, Pose::Identity(), noise);
  EXPECT_GT(filter.covariance()(0, 0), 0.5);
  EXPECT_EQ(filter.twist(), Twist::Zero());
  filter.step(0, Pose::Identity(), noise);
  EXPECT_EQ(filter.twist(), Twist::Zero()) << "stamps went back";
}

TEST(TwistFilter, ACovarianceFitsItsErrors) {
  std::mt19937 random(1);
  constexpr double kSigma = 0.001;
  const Eigen::Vector2d density(0.01, 0.03);  // as the filter has it
  double sum = 0;
  int count = 0;
  for (int run = 0; run < 40; ++run) {
    TwistFilter filter;
    Pose pose = Pose::Identity();
    Twist twist = noise_of(0.3, random);
    for (int i = 0; i < 60; ++i) {
      filter.step(i * kFrameNs, pose * se3_exp(noise_of(kSigma, random)),
                  kSigma * kSigma * Matrix6::Identity());
      const Twist off = filter.twist() - twist;
      if (i >= 15) {
        sum += off.dot(filter.covariance().ldlt().solve(off));
        ++count;
      }
      constexpr int kParts = 10;  // white acceleration, nearly
      for (int part = 0; part < kParts; ++part) {
        const double s = kFrameS / kParts;
        twist.head<3>() += noise_of(std::sqrt(density[0] * s), random).head<3>();
        twist.tail<3>() += noise_of(std::sqrt(density[1] * s), random).tail<3>();
        pose = pose * se3_exp(s * twist);
      }
    }
  }
  EXPECT_NEAR(sum / count, 6, 0.6);
}

}  // namespace
}  // namespace rds::tracker
