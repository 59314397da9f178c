// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using namespace test;

TEST(TrackerMap, APointThatIsNotFoundWhereItShouldBeLosesTrust) {
  Tracker tracker(small_config());
  step(tracker, 0);
  std::vector<PointId> covered;
  tracker.map().points().for_each([&](const MapPoint& p) {
    if (p.position.x() < -0.3) covered.push_back(p.id);
  });
  ASSERT_GT(covered.size(), 20U);
  const std::uint32_t before = tracker.map().point(covered.front())->visible;
  image::RgbdFrame hidden = test::picture_of_wall(truth(1), kFrameNs);
  hidden.color.pixels(cv::Rect(0, 0, 160, 240)).setTo(cv::Scalar(90, 90, 90));
  ASSERT_TRUE(has_pose(tracker.track(hidden, {}).state));
  const auto is_missed = [&](PointId id) {
    const MapPoint* p = tracker.map().point(id);
    return p != nullptr && p->visible > before && p->found < p->visible;
  };
  EXPECT_GT(std::ranges::count_if(covered, is_missed), 20);
}

TEST(TrackerMap, TheFirstFrameIsAKeyframeAtTheOrigin) {
  Tracker tracker(small_config());
  const FrameResult result = step(tracker, 0);
  ASSERT_TRUE(result.keyframe.has_value());
  EXPECT_EQ(result.keyframe->id, 0U);
  EXPECT_TRUE(result.map_from_camera.isApprox(Pose::Identity()));
  EXPECT_EQ(result.keyframe->features.size(), result.features);
  EXPECT_GE(result.keyframe->features.back().map_point_id, 0);
}

TEST(TrackerMap, AMapOfAKnownPlaceDoesNotGrow) {
  constexpr int kPassFrames = 14;
  TrackerConfig config = small_config();
  config.keyframe.known_after_s = 1;
  Tracker tracker(config);
  std::vector<std::size_t> keyframes, points;
  int looks = 0;
  for (int i = 0; i < 10 * kPassFrames; ++i) {
    const int k = i % (2 * kPassFrames);  // to and fro
    const Pose where = truth(3 * (k < kPassFrames ? k : 2 * kPassFrames - k));
    const FrameResult result = tracker.track(test::picture_of_wall(where, i * kFrameNs), {});
    ASSERT_EQ(result.state, State::kTracking) << i;
    looks += result.keyframe && !result.keyframe->in_map ? 1 : 0;
    if (const auto job = tracker.take_mapping_job()) tracker.apply(run_local_mapping(*job));
    EXPECT_EQ(tracker.known_places(), tracker.map().keyframes().size());
    if ((i + 1) % (2 * kPassFrames) != 0) continue;
    keyframes.push_back(tracker.map().keyframes().size());
    points.push_back(tracker.map().points().size());
  }
  EXPECT_GE(keyframes.front(), 3U);
  EXPECT_GE(looks, 3);
  EXPECT_LE(static_cast<double>(keyframes.back()), 1.4 * static_cast<double>(keyframes.front()));
  EXPECT_LE(static_cast<double>(points.back()), 1.4 * static_cast<double>(points.front()));
}

TEST(TrackerMap, AppliedMappingCausesNoJump) {
  Tracker tracker(small_config());
  std::optional<LocalMappingJob> job;
  FrameResult before;
  for (int i = 0; i < 10; ++i) {
    before = step(tracker, i);
    if (auto taken = tracker.take_mapping_job()) job = std::move(taken);
  }
  ASSERT_TRUE(job.has_value());
  EXPECT_FALSE(tracker.take_mapping_job().has_value());
  tracker.apply(run_local_mapping(*job));
  const FrameResult after = step(tracker, 10);
  EXPECT_EQ(after.state, State::kTracking);
  const Pose moved = before.map_from_camera.inverse() * after.map_from_camera;
  const Pose expected = truth(9).inverse() * truth(10);
  EXPECT_TRUE((moved.translation() - expected.translation()).norm() < 0.01);
}

TEST(TrackerMap, ACorrectionMovesTheCameraWithTheMap) {
  Tracker tracker(small_config());
  FrameResult before;
  for (int i = 0; i < 5; ++i) before = step(tracker, i);
  const Pose moved = test::pose(2, -1, 0.5, 0.7);
  std::vector<KeyframePose> correction;
  for (const KeyframePose& k : tracker.keyframe_poses())
    correction.push_back({k.id, k.stamp_ns, moved * k.map_from_camera});
  tracker.correct(correction);
  const FrameResult after = step(tracker, 5);
  ASSERT_EQ(after.state, State::kTracking);
  const Pose step_seen = (moved * before.map_from_camera).inverse() * after.map_from_camera;
  EXPECT_TRUE((step_seen.translation() - (truth(4).inverse() * truth(5)).translation()).norm() < 0.01);
}

TEST(TrackerMap, DropsAMappingResultFromBeforeACorrection) {
  Tracker tracker(small_config());
  for (int i = 0; i < 5; ++i) step(tracker, i);
  const auto job = tracker.take_mapping_job();
  ASSERT_TRUE(job.has_value());
  const auto result = run_local_mapping(*job);
  tracker.correct(std::vector<KeyframePose>{{0, 0, test::pose(1, 0, 0)}});
  const auto poses = tracker.keyframe_poses();
  tracker.apply(result);
  EXPECT_TRUE(tracker.keyframe_poses().back().map_from_camera.isApprox(poses.back().map_from_camera, 0));
}

/// The wall of the scene goes on outside every box: cut by depth it would stay.
TrackerConfig whole_boxes() {
  TrackerConfig config = small_config();
  config.removal.method = "box";
  return config;
}

TEST(TrackerMap, MakesNoMapPointsOnMovableObjects) {
  Tracker tracker(whole_boxes());
  const std::vector<segmentation::ObjectRegion> left{{{0, 0, 160, 240}, 0.5F, 4}};
  const FrameResult result = step(tracker, 0, left);
  ASSERT_TRUE(result.keyframe.has_value());
  EXPECT_GT(result.dynamic_features, 50U);
  int points = 0;
  for (const KeyframeFeature& f : result.keyframe->features) {
    EXPECT_EQ(f.feature.movable, f.feature.image_px.x() < 159.5F);
    if (f.feature.movable) {
      EXPECT_EQ(f.map_point_id, -1);
    }
    points += f.map_point_id >= 0 ? 1 : 0;
  }
  EXPECT_GT(points, 150);
}

TEST(TrackerMap, TakesBackPointsWhenBoxesComeLate) {
  Tracker tracker(whole_boxes());
  step(tracker, 0);
  const std::size_t before = tracker.map().points().size();
  tracker.retract_movable(0, std::vector<segmentation::ObjectRegion>{{{0, 0, 160, 240}, 0.5F, 4}});
  EXPECT_LT(tracker.map().points().size(), before * 3 / 4);
  EXPECT_EQ(step(tracker, 1).state, State::kTracking);
}

}  // namespace
}  // namespace rds::tracker
