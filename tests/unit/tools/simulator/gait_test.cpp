// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/people/gait.hpp"

#include <numbers>

#include <gtest/gtest.h>

namespace rds::simulator {
namespace {

Motion walking(double phase) {
  Motion motion;
  motion.position = {0.3, -0.4};
  motion.heading_rad = 0.8;
  motion.speed = 1;
  motion.phase_rad = phase;
  return motion;
}

TEST(Gait, LimbsKeepTheirLengthsInEveryPhase) {
  const BodyShape body;
  const Skeleton first = pose_skeleton(body, walking(0));
  for (int i = 0; i < 40; ++i) {
    const Skeleton s = pose_skeleton(body, walking(i * 0.4));
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR((s.legs[k].end - s.legs[k].middle).norm(),
                  (first.legs[k].end - first.legs[k].middle).norm(), 1e-5);
      EXPECT_NEAR((s.arms[k].end - s.arms[k].middle).norm(),
                  (first.arms[k].end - first.arms[k].middle).norm(), 1e-5);
    }
  }
}

TEST(Gait, OneFootIsAlwaysNearTheFloorAndNoneBelowIt) {
  const BodyShape body;
  for (int i = 0; i < 40; ++i) {
    const Skeleton s = pose_skeleton(body, walking(i * 0.4));
    const float lowest = std::min(s.legs[0].end.z(), s.legs[1].end.z());
    EXPECT_GT(lowest, 0.03F * body.height);
    EXPECT_LT(lowest, 0.12F * body.height);
  }
}

TEST(Gait, LeftAndRightSwapAfterHalfACycle) {
  const BodyShape body;
  const Skeleton a = pose_skeleton(body, walking(0.9));
  const Skeleton b = pose_skeleton(body, walking(0.9 + std::numbers::pi));
  EXPECT_NEAR(a.legs[0].end.z(), b.legs[1].end.z(), 1e-4);
  EXPECT_NEAR(a.legs[1].middle.z(), b.legs[0].middle.z(), 1e-4);
}

TEST(Gait, HeadIsAtBodyHeight) {
  BodyShape body;
  body.height = 1.8F;
  Motion standing;
  const float crown = pose_skeleton(body, standing).head.z() + 0.07F * body.height;
  EXPECT_NEAR(crown, body.height, 0.06F);
}

}  // namespace
}  // namespace rds::simulator
