// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/global_adjustment.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/loops/loop_fusion.hpp"
#include "services/tracker/core/motion/se3.hpp"
#include "tests/unit/services/tracker/core/mapping/two_laps.hpp"

namespace rds::tracker {
namespace {

using test::TwoLaps;

class GlobalAdjustment : public ::testing::Test {
 protected:
  GlobalAdjustment() { join_loop(laps.map, TwoLaps::loop()); }

  [[nodiscard]] LocalMappingJob job() const {
    LocalMappingJob made = make_global_job(laps.map);
    made.pyramid = ScalePyramid(8, 1.2);
    return made;
  }
  /// Largest distance of a keyframe from where it is in truth [m, rad].
  [[nodiscard]] double error() const {
    double largest = 0;
    for (KeyframeId k = 0; k < 2 * TwoLaps::kPerLap; ++k)
      largest = std::max(largest, se3_log(laps.map.pose_of(k).inverse() * TwoLaps::truth(k)).norm());
    return largest;
  }

  TwoLaps laps{test::pose(0.02, -0.01, 0.01, 0.01)};
};

TEST_F(GlobalAdjustment, ClosesWhatTheLoopLeavesOpen) {
  ASSERT_GT(error(), 0.02);
  const auto result = run_global_adjustment(job());
  ASSERT_TRUE(result);
  apply_global_adjustment(laps.map, *result);
  EXPECT_LT(error(), 0.006);
  EXPECT_TRUE(laps.map.pose_of(0).isApprox(TwoLaps::truth(0)));
}

TEST_F(GlobalAdjustment, WhatWasMadeMeanwhileMovesWithItsReference) {
  const auto result = run_global_adjustment(job());
  ASSERT_TRUE(result);
  laps.map.cull_keyframe(2);
  laps.add_keyframe(2 * TwoLaps::kPerLap + 4, laps.second_lap);
  const KeyframeId newest = 2 * TwoLaps::kPerLap;
  const PointId fresh = laps.map
                            .add_point({0, 0, 2}, newest,
                                       [&] {
                                         const auto& points = laps.map.keyframe(newest)->points;
                                         laps.map.forget(points[0], newest);
                                         return 0U;
                                       }())
                            .id;
  const Eigen::Vector3d in_camera = laps.map.pose_of(newest).inverse() * laps.map.point(fresh)->position;
  const KeyframeId reference = laps.map.keyframe(newest)->covisible.front().id;
  const Pose relative = laps.map.pose_of(reference).inverse() * laps.map.pose_of(newest);
  apply_global_adjustment(laps.map, *result);
  EXPECT_TRUE((laps.map.pose_of(reference).inverse() * laps.map.pose_of(newest)).isApprox(relative, 1e-9));
  EXPECT_TRUE(
      (laps.map.pose_of(newest).inverse() * laps.map.point(fresh)->position).isApprox(in_camera, 1e-9));
  EXPECT_LT(error(), 0.006);
}

TEST_F(GlobalAdjustment, WhatIsFixedStays) {
  laps.map.records().fix_all();
  laps.add_keyframe(2 * TwoLaps::kPerLap, laps.first_lap);
  const LocalMappingJob made = job();
  for (const MappingKeyframe& k : made.keyframes) EXPECT_EQ(k.fixed, k.id < 2 * TwoLaps::kPerLap);
  const Pose before = laps.map.pose_of(7);
  apply_global_adjustment(laps.map, *run_global_adjustment(made));
  EXPECT_EQ(laps.map.pose_of(7).matrix(), before.matrix());
}

TEST_F(GlobalAdjustment, GivesNothingWhenItIsStopped) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(run_global_adjustment(job(), stop.get_token()));
}

TEST_F(GlobalAdjustment, GivesTheSameBytesTwice) {
  const auto a = run_global_adjustment(job());
  const auto b = run_global_adjustment(job());
  ASSERT_EQ(a->points.size(), b->points.size());
  for (std::size_t i = 0; i < a->points.size(); ++i) EXPECT_EQ(a->points[i].position, b->points[i].position);
  for (std::size_t i = 0; i < a->keyframes.size(); ++i)
    EXPECT_EQ(a->keyframes[i].map_from_camera.matrix(), b->keyframes[i].map_from_camera.matrix());
}

TEST(GlobalAdjustmentOfNothing, IsEmpty) {
  const auto result = run_global_adjustment(make_global_job(SlamMap(ScalePyramid(8, 1.2))));
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->keyframes.empty());
}

}  // namespace
}  // namespace rds::tracker
