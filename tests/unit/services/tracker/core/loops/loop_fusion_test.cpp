// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/loops/loop_fusion.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/map/local_map.hpp"
#include "services/tracker/core/motion/se3.hpp"
#include "tests/unit/services/tracker/core/mapping/two_laps.hpp"

namespace rds::tracker {
namespace {

using test::TwoLaps;

class LoopFusion : public ::testing::Test {
 protected:
  TwoLaps laps{test::pose(0.05, -0.03, 0.02, 0.02)};
};

TEST_F(LoopFusion, WhatBothSidesSeeBecomesOnePoint) {
  const std::size_t before = laps.map.points().size();
  const auto replaced = join_loop(laps.map, TwoLaps::loop());
  ASSERT_TRUE(replaced);
  EXPECT_EQ(laps.map.points().size(), before - replaced->size());
  std::size_t twice = 0;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < TwoLaps::kPoints; ++i) {
    twice += laps.map.point(laps.first_lap[i]) != nullptr && laps.map.point(laps.second_lap[i]) != nullptr;
    for (const auto& [from, to] :
         {std::pair{laps.second_lap[i], laps.first_lap[i]}, std::pair{laps.first_lap[i], laps.second_lap[i]}})
      if (const auto found = replaced->find(from); found != replaced->end()) wrong += found->second != to;
  }
  EXPECT_LT(twice, TwoLaps::kPoints / 20);
  EXPECT_EQ(wrong, 0U);
}

TEST_F(LoopFusion, TheLocalMapSeesBothSides) {
  ASSERT_EQ(laps.shared(9, 4), 0);
  ASSERT_TRUE(join_loop(laps.map, TwoLaps::loop()));
  EXPECT_GT(laps.shared(9, 4), 100);
  EXPECT_GT(laps.shared(5, 0), 100);
  const LocalMap local = select_local_map(laps.map, laps.map.keyframe(9)->points, 1);
  EXPECT_EQ(local.keyframes.size(), 2 * TwoLaps::kPerLap);
}

TEST_F(LoopFusion, AMeasurementThatIsOffByItsNoiseIsGoodEnough) {
  ASSERT_TRUE(join_loop(laps.map, TwoLaps::loop(test::pose(0.006, 0.004, -0.005, 0.003))));
  EXPECT_GT(laps.shared(9, 4), 100);
}

TEST_F(LoopFusion, AnotherPlaceIsNotJoined) {
  const std::size_t before = laps.map.points().size();
  EXPECT_FALSE(join_loop(laps.map, TwoLaps::loop(test::pose(0.4, 0.1, 0, 0.2))));
  EXPECT_FALSE(join_loop(laps.map, {1000, 3, Pose::Identity()}));
  EXPECT_EQ(laps.map.points().size(), before);
  EXPECT_EQ(laps.shared(9, 4), 0);
}

TEST_F(LoopFusion, AKeyframeThatWasCulledStandsForItsAnchor) {
  laps.map.cull_keyframe(3);
  laps.map.cull_keyframe(9);
  ASSERT_TRUE(join_loop(laps.map, TwoLaps::loop()));
  EXPECT_GT(laps.shared(8, 4), 100);
}

TEST_F(LoopFusion, JoinsOnceAndNotAgain) {
  ASSERT_TRUE(join_loop(laps.map, TwoLaps::loop()));
  const std::size_t after = laps.map.points().size();
  join_loop(laps.map, TwoLaps::loop());
  EXPECT_EQ(laps.map.points().size(), after);
}

/// The second lap goes on from the first: keyframes 4 and 5 are covisible.
void go_on(TwoLaps& laps) {
  laps.map.keyframe(4)->covisible.push_back({5, 20});
  laps.map.keyframe(5)->covisible.push_back({4, 20});
}

TEST(LoopConfirmation, ASmallDriftIsConfirmed) {
  TwoLaps laps(test::pose(0.1, 0.05, 0, 0.02));
  go_on(laps);
  EXPECT_TRUE(confirms(laps.map, std::vector{TwoLaps::loop()}));
}

TEST(LoopConfirmation, WhatTheMapCannotHaveDriftedIsRefusedWhereLooksSayNothing) {
  TwoLaps laps(test::pose(5, 0, 0));
  EXPECT_TRUE(confirms(laps.map, std::vector{TwoLaps::loop()})) << "nothing joins the laps, as with submaps";
  go_on(laps);
  EXPECT_FALSE(confirms(laps.map, std::vector{TwoLaps::loop()}));
}

TEST(LoopConfirmation, WhatTheMapDoesNotKnowOrShowIsRefused) {
  const TwoLaps laps(test::pose(0.1, 0.05, 0, 0.02));
  EXPECT_FALSE(confirms(laps.map, std::vector<LoopMatch>{{1000, 3, Pose::Identity()}}));
  EXPECT_FALSE(confirms(laps.map, std::vector{TwoLaps::loop(test::pose(0.4, 0.1, 0, 0.2))}));
}

}  // namespace
}  // namespace rds::tracker
