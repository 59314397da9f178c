// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/odometry_buffer.hpp"

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

using geometry::Pose;

constexpr std::int64_t kStepNs = 20'000'000;

Pose at_x(double x, double yaw_rad = 0) {
  return geometry::make_pose({x, 0, 0},
                             Eigen::Quaterniond(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())));
}

/// Drives at half a metre a second.
OdometryBuffer driven(int steps) {
  OdometryBuffer buffer;
  for (int i = 0; i < steps; ++i) buffer.add(i * kStepNs, at_x(0.01 * i));
  return buffer;
}

TEST(OdometryBuffer, InterpolatesBetweenNeighbours) {
  const OdometryBuffer buffer = driven(10);
  EXPECT_TRUE(buffer.at(3 * kStepNs)->odom_from_body.isApprox(at_x(0.03), 1e-12));
  EXPECT_TRUE(buffer.at(3 * kStepNs + kStepNs / 4)->odom_from_body.isApprox(at_x(0.0325), 1e-12));
  EXPECT_FALSE(buffer.at(-1));
  EXPECT_FALSE(OdometryBuffer().at(0));
}

TEST(OdometryBuffer, GoesALittleBeyondTheNewestAndNoFurther) {
  const OdometryBuffer buffer = driven(10);
  const std::int64_t newest = 9 * kStepNs;
  EXPECT_EQ(buffer.newest_ns(), newest);
  EXPECT_TRUE(buffer.at(newest + kStepNs)->odom_from_body.isApprox(at_x(0.1), 1e-9));
  EXPECT_TRUE(buffer.at(newest + OdometryBuffer::kMaxAheadNs));
  EXPECT_FALSE(buffer.at(newest + OdometryBuffer::kMaxAheadNs + 1));
}

TEST(OdometryBuffer, SaysNothingInAGap) {
  OdometryBuffer buffer = driven(10);
  buffer.add(9 * kStepNs + OdometryBuffer::kMaxGapNs + 1, at_x(0.2));
  EXPECT_FALSE(buffer.at(10 * kStepNs));
}

TEST(OdometryBuffer, DropsWhatIsLateOrToldTwice) {
  OdometryBuffer buffer = driven(10);
  buffer.add(9 * kStepNs, at_x(7));
  buffer.add(5 * kStepNs, at_x(7));
  EXPECT_TRUE(buffer.at(9 * kStepNs)->odom_from_body.isApprox(at_x(0.09), 1e-12));
}

TEST(OdometryBuffer, BeginsASegmentWhereTheOdometryOrItsClockBeginsAgain) {
  OdometryBuffer buffer = driven(200);
  const std::uint64_t first = buffer.at(0)->segment;
  buffer.add(200 * kStepNs, at_x(0));  // 2 m back within 20 ms
  buffer.add(201 * kStepNs, at_x(0));
  EXPECT_FALSE(buffer.at(100 * kStepNs));
  const std::uint64_t second = buffer.at(200 * kStepNs)->segment;
  EXPECT_NE(second, first);
  buffer.add(0, at_x(0));
  EXPECT_NE(buffer.at(0)->segment, second);
}

TEST(OdometryBuffer, ForgetsWhatIsOld) {
  const OdometryBuffer buffer = driven(600);
  EXPECT_FALSE(buffer.at(599 * kStepNs - OdometryBuffer::kKeptNs - 1));
  EXPECT_TRUE(buffer.at(599 * kStepNs - OdometryBuffer::kKeptNs));
}

}  // namespace
}  // namespace rds::tracker
