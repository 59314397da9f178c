// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/tracker.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr std::int64_t kFrameNs = 66'000'000;

TrackerConfig small_config() {
  TrackerConfig config;
  config.extraction.features = 500;
  config.extraction.levels = 4;
  return config;
}

Pose truth(int frame) {
  return test::pose(0.015 * frame, 0.004 * frame, 0.01 * frame, 0.004 * frame);
}

FrameResult step(Tracker& tracker, int frame, std::span<const MovableRegion> movable = {}) {
  return tracker.track(test::picture_of_wall(truth(frame), frame * kFrameNs), movable);
}

double error_m(const FrameResult& result, int frame) {
  const Pose expected = truth(0).inverse() * truth(frame);
  return (expected.translation() - result.map_from_camera.translation()).norm();
}

TEST(Tracker, FollowsAMovingCamera) {
  Tracker tracker(small_config());
  for (int i = 0; i < 12; ++i) {
    const FrameResult result = step(tracker, i);
    ASSERT_EQ(result.state, State::kTracking) << i;
    EXPECT_TRUE(error_m(result, i) < 0.015) << i << ": " << error_m(result, i);
    EXPECT_EQ(result.verdicts.size(), result.features);
  }
  EXPECT_GT(tracker.map().keyframes(), 1U);
}

/// A camera like the first Kinect's, whatever its size; depth comes in mm.
void expect_to_follow_with(int width, int height, int frames) {
  const double f = 0.81 * width;
  const geometry::CameraModel camera{
      width, height, f, f, 0.498 * width, 0.52 * height, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
  Tracker tracker(small_config());
  for (int i = 0; i < frames; ++i) {
    image::RgbdFrame frame = test::picture_of_wall(truth(2 * i), i * kFrameNs, camera);
    cv::Mat mm;
    frame.depth.values.convertTo(mm, CV_16UC1, 1000);
    frame.depth.values = mm;
    frame.depth.metres_per_unit = 0.001F;
    const FrameResult result = tracker.track(frame, {});
    ASSERT_EQ(result.state, State::kTracking) << i;
    EXPECT_TRUE(error_m(result, 2 * i) < 0.015) << i << ": " << error_m(result, 2 * i);
  }
}

TEST(Tracker, FollowsWithASmallPicture) {
  expect_to_follow_with(320, 240, 8);
}

TEST(Tracker, FollowsWithALargePicture) {
  expect_to_follow_with(1280, 720, 5);
}

TEST(Tracker, FollowsPointsAndExtractsForKeyframesOnly) {
  TrackerConfig config = small_config();
  config.following.points = 120;
  Tracker tracker(config);
  int followed = 0;
  for (int i = 0; i < 12; ++i) {
    const FrameResult result = step(tracker, i);
    ASSERT_EQ(result.state, State::kTracking) << i;
    if (result.keyframe) continue;
    EXPECT_LE(result.features, 120U);
    EXPECT_EQ(result.times.extract_us, 0);
    ++followed;
  }
  EXPECT_GE(followed, 5);
}

TEST(Tracker, APointThatIsNotFoundWhereItShouldBeLosesTrust) {
  Tracker tracker(small_config());
  step(tracker, 0);
  std::vector<PointId> covered;
  tracker.map().all_points().for_each([&](const MapPoint& p) {
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

TEST(Tracker, TheFirstFrameIsAKeyframeAtTheOrigin) {
  Tracker tracker(small_config());
  const FrameResult result = step(tracker, 0);
  ASSERT_TRUE(result.keyframe.has_value());
  EXPECT_EQ(result.keyframe->id, 0U);
  EXPECT_TRUE(result.map_from_camera.isApprox(Pose::Identity()));
  EXPECT_EQ(result.keyframe->features.size(), result.features);
  EXPECT_GE(result.keyframe->features.back().map_point_id, 0);
}

TEST(Tracker, InventsNoPoseWhenNothingIsSeenAndFindsBack) {
  Tracker tracker(small_config());
  EXPECT_EQ(tracker.track(test::dark_picture(0), {}).state, State::kNotInitialized);
  for (int i = 1; i < 6; ++i) step(tracker, i);
  const FrameResult lost = tracker.track(test::dark_picture(6 * kFrameNs), {});
  EXPECT_EQ(lost.state, State::kLost);
  EXPECT_FALSE(has_pose(lost.state));
  EXPECT_FALSE(lost.keyframe.has_value());
  const FrameResult found = step(tracker, 7);
  EXPECT_EQ(found.state, State::kRelocalised);
  const Pose expected = truth(1).inverse() * truth(7);
  EXPECT_TRUE((found.map_from_camera.translation() - expected.translation()).norm() < 0.02);
}

/// A depth camera that misses every second picture and, at the end, all of them.
void expect_tracking_without_depth(bool following) {
  TrackerConfig config = small_config();
  config.following.enabled = following;
  Tracker tracker(config);
  for (int i = 0; i < 24; ++i) {
    image::RgbdFrame picture = test::picture_of_wall(truth(i), i * kFrameNs);
    const bool has_depth = i % 2 == 0 && i < 12;
    if (!has_depth) picture.depth = image::empty_depth(picture.color.pixels.size());
    const FrameResult result = tracker.track(picture, {});
    ASSERT_EQ(result.state, State::kTracking) << i;
    EXPECT_TRUE(error_m(result, i) < 0.02) << i << ": " << error_m(result, i);
    EXPECT_TRUE(has_depth || !result.keyframe) << i;
  }
  EXPECT_GT(tracker.map().keyframes(), 1U);
}

TEST(Tracker, FollowsPointsThroughFramesWithoutDepth) {
  expect_tracking_without_depth(true);
}

TEST(Tracker, TracksFeaturesInFramesWithoutDepth) {
  expect_tracking_without_depth(false);
}

TEST(Tracker, StartsWithDepthOnly) {
  Tracker tracker(small_config());
  image::RgbdFrame picture = test::picture_of_wall(truth(0), 0);
  picture.depth = image::empty_depth(picture.color.pixels.size());
  EXPECT_EQ(tracker.track(picture, {}).state, State::kNotInitialized);
  EXPECT_TRUE(step(tracker, 1).keyframe.has_value());
}

TEST(Tracker, FollowsPointsAgainAsSoonAsItHasFoundBack) {
  Tracker tracker(small_config());
  for (int i = 0; i < 8; ++i) step(tracker, i);
  for (int i = 8; i < 14; ++i)
    EXPECT_EQ(tracker.track(test::dark_picture(i * kFrameNs), {}).state, State::kLost);
  EXPECT_EQ(step(tracker, 14).state, State::kRelocalised);
  const FrameResult next = step(tracker, 15);
  EXPECT_EQ(next.state, State::kTracking);
  EXPECT_TRUE(error_m(next, 15) < 0.02) << error_m(next, 15);
  EXPECT_TRUE(next.keyframe || next.times.extract_us == 0);
}

TEST(Tracker, StaysLostWhereNothingIsKnown) {
  Tracker tracker(small_config());
  for (int i = 0; i < 6; ++i) step(tracker, i);
  for (int i = 6; i < 50; ++i) {
    const FrameResult elsewhere =
        tracker.track(test::picture_of_wall(test::pose(2.7, 2.4, 0), i * kFrameNs), {});
    EXPECT_EQ(elsewhere.state, State::kLost) << i;
    EXPECT_FALSE(elsewhere.keyframe) << i;
  }
  EXPECT_EQ(tracker.track(test::picture_of_wall(truth(4), 50 * kFrameNs), {}).state, State::kRelocalised);
}

TEST(Tracker, AJumpToAKnownPlaceIsSaidToBeOne) {
  Tracker tracker(small_config());
  for (int i = 0; i < 50; ++i) ASSERT_EQ(step(tracker, i).state, State::kTracking) << i;
  for (int i = 0; i < 6; ++i) {
    const FrameResult result = tracker.track(test::picture_of_wall(truth(3 + i), (50 + i) * kFrameNs), {});
    EXPECT_EQ(result.state, i == 0 ? State::kRelocalised : State::kTracking) << i;
    EXPECT_TRUE(error_m(result, 3 + i) < 0.02) << i << ": " << error_m(result, 3 + i);
  }
}

TEST(Tracker, SurvivesJumpsOfExposure) {
  Tracker tracker(small_config());
  for (int i = 0; i < 12; ++i) {
    image::RgbdFrame picture = test::picture_of_wall(truth(i), i * kFrameNs);
    picture.color.pixels *= i / 3 % 2 == 0 ? 0.9 : 0.45;
    const FrameResult result = tracker.track(picture, {});
    ASSERT_EQ(result.state, State::kTracking) << i;
    EXPECT_TRUE(error_m(result, i) < 0.015) << i << ": " << error_m(result, i);
  }
}

TEST(Tracker, TheEdgeOfWhatCoversTheLensDoesNotMoveTheCamera) {
  Tracker tracker(small_config());
  for (int i = 0; i < 24; ++i) {
    image::RgbdFrame picture = test::picture_of_wall(truth(i), i * kFrameNs);
    const int covered = std::clamp(i < 16 ? 40 * (i - 6) : 40 * (23 - i), 0, 320);
    picture.color.pixels(cv::Rect(0, 0, covered, 240)).setTo(cv::Scalar(8, 8, 8));
    const FrameResult result = tracker.track(picture, {});
    if (covered <= 160) {
      EXPECT_TRUE(has_pose(result.state)) << i;
    }
    if (covered == 320) {
      EXPECT_EQ(result.state, State::kLost) << i;
    }
    if (has_pose(result.state)) {
      EXPECT_TRUE(error_m(result, i) < 0.07) << i << ": " << error_m(result, i);
    }
  }
}

TEST(Tracker, GivesTheSameBytesTwice) {
  Tracker a(small_config());
  Tracker b(small_config());
  for (int i = 0; i < 6; ++i)
    EXPECT_EQ(step(a, i).map_from_camera.matrix(), step(b, i).map_from_camera.matrix());
}

TEST(Tracker, AMapOfAKnownPlaceDoesNotGrow) {
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
    if (const auto job = tracker.take_mapping_job())
      tracker.apply(run_local_mapping(*job, config.local_mapping));
    EXPECT_EQ(tracker.known_places(), tracker.map().keyframes());
    if ((i + 1) % (2 * kPassFrames) != 0) continue;
    keyframes.push_back(tracker.map().keyframes());
    points.push_back(tracker.map().points());
  }
  EXPECT_GE(keyframes.front(), 3U);
  EXPECT_GE(looks, 3);
  EXPECT_LE(static_cast<double>(keyframes.back()), 1.4 * static_cast<double>(keyframes.front()));
  EXPECT_LE(static_cast<double>(points.back()), 1.4 * static_cast<double>(points.front()));
}

TEST(Tracker, AppliedMappingCausesNoJump) {
  Tracker tracker(small_config());
  std::optional<LocalMappingJob> job;
  FrameResult before;
  for (int i = 0; i < 10; ++i) {
    before = step(tracker, i);
    if (auto taken = tracker.take_mapping_job()) job = std::move(taken);
  }
  ASSERT_TRUE(job.has_value());
  EXPECT_FALSE(tracker.take_mapping_job().has_value());
  tracker.apply(run_local_mapping(*job, LocalMappingConfig{}));
  const FrameResult after = step(tracker, 10);
  EXPECT_EQ(after.state, State::kTracking);
  const Pose moved = before.map_from_camera.inverse() * after.map_from_camera;
  const Pose expected = truth(9).inverse() * truth(10);
  EXPECT_TRUE((moved.translation() - expected.translation()).norm() < 0.01);
}

TEST(Tracker, ACorrectionMovesTheCameraWithTheMap) {
  Tracker tracker(small_config());
  FrameResult before;
  for (int i = 0; i < 5; ++i) before = step(tracker, i);
  const Pose moved = test::pose(2, -1, 0.5, 0.7);
  PoseGraphCorrection correction;
  for (const KeyframePose& k : tracker.keyframe_poses())
    correction.poses.push_back({k.id, k.stamp_ns, moved * k.map_from_camera});
  tracker.apply(correction);
  const FrameResult after = step(tracker, 5);
  ASSERT_EQ(after.state, State::kTracking);
  const Pose step_seen = (moved * before.map_from_camera).inverse() * after.map_from_camera;
  EXPECT_TRUE((step_seen.translation() - (truth(4).inverse() * truth(5)).translation()).norm() < 0.01);
}

TEST(Tracker, DropsAMappingResultFromBeforeACorrection) {
  Tracker tracker(small_config());
  for (int i = 0; i < 5; ++i) step(tracker, i);
  const auto job = tracker.take_mapping_job();
  ASSERT_TRUE(job.has_value());
  const auto result = run_local_mapping(*job, LocalMappingConfig{});
  tracker.apply(PoseGraphCorrection{{{0, 0, test::pose(1, 0, 0)}}});
  const auto poses = tracker.keyframe_poses();
  tracker.apply(result);
  EXPECT_TRUE(tracker.keyframe_poses().back().map_from_camera.isApprox(poses.back().map_from_camera, 0));
}

TEST(Tracker, MakesNoMapPointsOnMovableObjects) {
  Tracker tracker(small_config());
  const std::vector<MovableRegion> left{{{0, 0, 160, 240}, 0.5F, 4}};
  const FrameResult result = step(tracker, 0, left);
  ASSERT_TRUE(result.keyframe.has_value());
  EXPECT_GT(result.dynamic_features, 50U);
  int points = 0;
  for (const KeyframeFeature& f : result.keyframe->features) {
    EXPECT_EQ(f.feature.movable, f.feature.image_px.x() < 160);
    if (f.feature.movable) {
      EXPECT_EQ(f.map_point_id, -1);
    }
    points += f.map_point_id >= 0 ? 1 : 0;
  }
  EXPECT_GT(points, 150);
}

TEST(Tracker, TakesBackPointsWhenBoxesComeLate) {
  Tracker tracker(small_config());
  step(tracker, 0);
  const std::size_t before = tracker.map().points();
  tracker.retract_movable(0, std::vector<MovableRegion>{{{0, 0, 160, 240}, 0.5F, 4}});
  EXPECT_LT(tracker.map().points(), before * 3 / 4);
  EXPECT_EQ(step(tracker, 1).state, State::kTracking);
}

TEST(Tracker, SurvivesBadPictures) {
  Tracker tracker(small_config());
  image::RgbdFrame empty;
  EXPECT_EQ(tracker.track(empty, {}).state, State::kNotInitialized);
  step(tracker, 0);
  EXPECT_EQ(tracker.track(empty, {}).state, State::kLost);
  image::RgbdFrame small_depth = test::picture_of_wall(truth(1), kFrameNs);
  small_depth.depth.values = cv::Mat(3, 3, CV_16UC1);
  EXPECT_EQ(tracker.track(small_depth, {}).state, State::kLost);
  image::RgbdFrame nan = test::picture_of_wall(truth(1), kFrameNs);
  nan.depth.values.setTo(std::numeric_limits<float>::quiet_NaN());
  tracker.track(nan, {});
  EXPECT_EQ(step(tracker, 2).state, State::kTracking);
}

/// Poses of another map's frame, off by more than the camera moves; none at frame 5.
GivenPoses poses_elsewhere() {
  return [](std::int64_t stamp_ns) -> std::optional<Pose> {
    if (stamp_ns == 5 * kFrameNs) return std::nullopt;
    return test::pose(3, -2, 1, 0.5) * truth(static_cast<int>(stamp_ns / kFrameNs));
  };
}

TEST(Tracker, FollowsGivenPosesAndMovesNone) {
  Tracker tracker(small_config(), poses_elsewhere());
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(tracker.expected_camera_from_map(i * kFrameNs).matrix() ==
                  poses_elsewhere()(i * kFrameNs).value_or(Pose::Identity()).inverse().matrix(),
              i != 5);
    const FrameResult result = step(tracker, i);
    ASSERT_EQ(result.state, i == 5 ? State::kLost : State::kTracking) << i;
    if (i == 5) continue;
    EXPECT_TRUE(result.map_from_camera.isApprox(*poses_elsewhere()(i * kFrameNs), 1e-12)) << i;
    EXPECT_GT(i == 0 ? 100U : result.inliers, 90U) << i;  // what the map has is found, after the gap too
    if (const auto job = tracker.take_mapping_job())
      tracker.apply(run_local_mapping(*job, LocalMappingConfig{}));
    tracker.apply(PoseGraphCorrection{{{0, 0, test::pose(1, 0, 0)}}});
  }
  EXPECT_GT(tracker.map().keyframes(), 1U);
  for (const KeyframePose& k : tracker.keyframe_poses())
    EXPECT_TRUE(k.map_from_camera.isApprox(*poses_elsewhere()(k.stamp_ns), 1e-12)) << k.id;
}

TEST(Tracker, FollowsGivenPosesThroughTheDark) {
  Tracker tracker(small_config(), poses_elsewhere());
  EXPECT_EQ(tracker.track(test::dark_picture(0), {}).state, State::kTracking);
  EXPECT_EQ(tracker.track(test::dark_picture(kFrameNs), {}).inliers, 0U);
  step(tracker, 2);
  EXPECT_GT(step(tracker, 3).inliers, 90U);
}

TEST(Tracker, HasNoPoseBeforeTheFirstGivenOne) {
  Tracker tracker(small_config(), poses_elsewhere());
  EXPECT_EQ(step(tracker, 5).state, State::kNotInitialized);
  EXPECT_EQ(step(tracker, 6).keyframe->id, 0U);
  tracker.reset();
  EXPECT_TRUE(step(tracker, 7).map_from_camera.isApprox(*poses_elsewhere()(7 * kFrameNs), 1e-12));
}

TEST(Tracker, ForgetsEverythingOnReset) {
  Tracker tracker(small_config());
  for (int i = 0; i < 3; ++i) step(tracker, i);
  tracker.reset();
  EXPECT_TRUE(tracker.keyframe_poses().empty());
  EXPECT_EQ(step(tracker, 8).keyframe->id, 0U);
}

}  // namespace
}  // namespace rds::tracker
