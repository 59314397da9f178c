// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/first_poses.hpp"

#include <gtest/gtest.h>

namespace rds::transformer {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

geometry::KeyframePose keyframe(std::uint64_t id, std::int64_t stamp_s, double x_m) {
  geometry::KeyframePose pose{id, stamp_s * kSecond, geometry::Pose::Identity()};
  pose.map_from_camera.translation().x() = x_m;
  return pose;
}

/// x of the keyframe's pose [m]; NaN if none is known.
double x_at(const FirstPoses& poses, std::int64_t stamp_s) {
  const auto pose = poses.of(stamp_s * kSecond);
  return pose ? pose->translation().x() : std::numeric_limits<double>::quiet_NaN();
}

TEST(FirstPoses, GivesThePoseThatWasToldFirst) {
  FirstPoses poses(10);
  poses.take(std::vector{keyframe(5, 1, 0.1)});
  poses.take(std::vector{keyframe(5, 1, 0.7), keyframe(6, 2, 0.2)});
  EXPECT_EQ(x_at(poses, 1), 0.1);
  EXPECT_EQ(x_at(poses, 2), 0.2);
  EXPECT_FALSE(poses.of(3 * kSecond));
}

TEST(FirstPoses, TakesAKeyframeThatIsToldLate) {
  FirstPoses poses(10);
  poses.take(std::vector{keyframe(5, 1, 0.1)});
  poses.take(std::vector{keyframe(7, 3, 0.3)});
  poses.take(std::vector{keyframe(5, 1, 0.5), keyframe(6, 2, 0.2), keyframe(7, 3, 0.7)});
  EXPECT_EQ(x_at(poses, 1), 0.1);
  EXPECT_EQ(x_at(poses, 2), 0.2);
  EXPECT_EQ(x_at(poses, 3), 0.3);
}

TEST(FirstPoses, OfTwoKeyframesWithOneStampTheNewerCounts) {
  FirstPoses poses(10);
  poses.take(std::vector{keyframe(0, 1, 0.1), keyframe(1, 2, 0.2), keyframe(2, 1, 0.3)});
  EXPECT_EQ(x_at(poses, 1), 0.3);
  EXPECT_FALSE(poses.of(2 * kSecond)) << "of the time before stamps went back";
  poses.take(std::vector{keyframe(0, 1, 0.1), keyframe(1, 2, 0.2), keyframe(2, 1, 0.3), keyframe(3, 2, 0.4)});
  EXPECT_EQ(x_at(poses, 1), 0.3);
  EXPECT_EQ(x_at(poses, 2), 0.4);
}

TEST(FirstPoses, KeepsTheNewestKeyframesWhateverTheirStamps) {
  FirstPoses poses(3);
  for (int i = 0; i < 5; ++i) poses.take(std::vector{keyframe(static_cast<std::uint64_t>(i), 2000 + i, i)});
  EXPECT_FALSE(poses.of(2001 * kSecond));
  EXPECT_EQ(x_at(poses, 2002), 2);
  for (int i = 5; i < 10; ++i) poses.take(std::vector{keyframe(static_cast<std::uint64_t>(i), 1000 + i, i)});
  EXPECT_EQ(x_at(poses, 1009), 9);
  EXPECT_EQ(x_at(poses, 1007), 7);
  EXPECT_FALSE(poses.of(1006 * kSecond));
}

TEST(FirstPoses, WhatWasForgottenIsNotTakenForNew) {
  FirstPoses poses(1);
  poses.take(std::vector{keyframe(0, 1, 0.1), keyframe(1, 2, 0.2)});
  poses.take(std::vector{keyframe(0, 1, 0.5), keyframe(1, 2, 0.6)});
  EXPECT_FALSE(poses.of(1 * kSecond));
  EXPECT_EQ(x_at(poses, 2), 0.2);
  poses.clear();
  poses.take(std::vector{keyframe(0, 1, 0.5)});
  EXPECT_EQ(x_at(poses, 1), 0.5);
}

TEST(FirstPoses, AnIdThatCannotBeReachedShutsNobodyOut) {
  FirstPoses poses(10);
  geometry::KeyframePose real{5, 5'000'000'000, geometry::Pose::Identity()};
  poses.take({&real, 1});
  const geometry::KeyframePose spoiled{~std::uint64_t{0} - 1, 1'000'000'000, geometry::Pose::Identity()};
  poses.take({&spoiled, 1});
  real = {6, 6'000'000'000, geometry::Pose::Identity()};
  poses.take({&real, 1});
  EXPECT_TRUE(poses.of(5'000'000'000));
  EXPECT_TRUE(poses.of(6'000'000'000));
  EXPECT_FALSE(poses.of(1'000'000'000));
}

}  // namespace
}  // namespace rds::transformer
