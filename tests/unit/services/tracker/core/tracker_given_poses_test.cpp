// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using namespace test;

/// Poses of another map's frame, off by more than the camera moves; none at frame 5.
GivenPoses poses_elsewhere() {
  return [](std::int64_t stamp_ns) -> std::optional<Pose> {
    if (stamp_ns == 5 * kFrameNs) return std::nullopt;
    return test::pose(3, -2, 1, 0.5) * truth(static_cast<int>(stamp_ns / kFrameNs));
  };
}

TEST(TrackerGivenPoses, FollowsGivenPosesAndMovesNone) {
  Tracker tracker(small_config(), {.given_poses = poses_elsewhere()});
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(tracker.expected_camera_from_map(i * kFrameNs).matrix() ==
                  poses_elsewhere()(i * kFrameNs).value_or(Pose::Identity()).inverse().matrix(),
              i != 5);
    const FrameResult result = step(tracker, i);
    ASSERT_EQ(result.state, i == 5 ? State::kLost : State::kTracking) << i;
    if (i == 5) continue;
    EXPECT_TRUE(result.map_from_camera.isApprox(*poses_elsewhere()(i * kFrameNs), 1e-12)) << i;
    EXPECT_GT(i == 0 ? 100U : result.inliers, 90U) << i;  // what the map has is found, after the gap too
    if (const auto job = tracker.take_mapping_job()) tracker.apply(run_local_mapping(*job));
    tracker.correct(std::vector<KeyframePose>{{0, 0, test::pose(1, 0, 0)}});
  }
  EXPECT_GT(tracker.map().keyframes().size(), 1U);
  for (const KeyframePose& k : tracker.keyframe_poses())
    EXPECT_TRUE(k.map_from_camera.isApprox(*poses_elsewhere()(k.stamp_ns), 1e-12)) << k.id;
}

TEST(TrackerGivenPoses, FollowsGivenPosesThroughTheDark) {
  Tracker tracker(small_config(), {.given_poses = poses_elsewhere()});
  EXPECT_EQ(tracker.track(test::dark_picture(0), {}).state, State::kTracking);
  EXPECT_EQ(tracker.track(test::dark_picture(kFrameNs), {}).inliers, 0U);
  step(tracker, 2);
  EXPECT_GT(step(tracker, 3).inliers, 90U);
}

TEST(TrackerGivenPoses, ALongGapInThemBeginsNoSubmap) {
  const auto gap = [](std::int64_t stamp_ns) { return stamp_ns >= 3 * kFrameNs && stamp_ns < 30 * kFrameNs; };
  TrackerConfig config = small_config();
  config.young_map_s = 0;
  const GivenPoses given = [&](std::int64_t stamp_ns) -> std::optional<Pose> {
    if (gap(stamp_ns)) return std::nullopt;
    return truth(static_cast<int>(stamp_ns / kFrameNs));
  };
  Tracker tracker(config, {.given_poses = given});
  for (int i = 0; i < 32; ++i) {
    const FrameResult result = step(tracker, i);
    EXPECT_EQ(result.state, gap(i * kFrameNs) ? State::kLost : State::kTracking) << i;
    EXPECT_EQ(result.submap, Submaps::kMap) << i;
  }
}

TEST(TrackerGivenPoses, HasNoPoseBeforeTheFirstGivenOne) {
  Tracker tracker(small_config(), {.given_poses = poses_elsewhere()});
  EXPECT_EQ(step(tracker, 5).state, State::kNotInitialized);
  EXPECT_EQ(step(tracker, 6).keyframe->id, 0U);
  tracker.reset();
  EXPECT_TRUE(step(tracker, 7).map_from_camera.isApprox(*poses_elsewhere()(7 * kFrameNs), 1e-12));
}

}  // namespace
}  // namespace rds::tracker
