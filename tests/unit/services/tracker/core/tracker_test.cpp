// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using namespace test;

using test::error_m;
using test::kFrameNs;
using test::small_config;
using test::step;
using test::truth;

TEST(Tracker, FollowsAMovingCamera) {
  Tracker tracker(small_config());
  for (int i = 0; i < 12; ++i) {
    const FrameResult result = step(tracker, i);
    ASSERT_EQ(result.state, State::kTracking) << i;
    EXPECT_TRUE(error_m(result, i) < 0.015) << i << ": " << error_m(result, i);
    EXPECT_EQ(result.verdicts.size(), result.features);
  }
  EXPECT_GT(tracker.map().keyframes().size(), 1U);
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

/// A depth camera that misses every second picture and, at the end, all of them. (Where points are
/// triangulated, such pictures may become keyframes: tracker_depth_gap_test.cpp.)
void expect_tracking_without_depth(bool following) {
  TrackerConfig config = small_config();
  config.depth.triangulate = false;
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
  EXPECT_GT(tracker.map().keyframes().size(), 1U);
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

TEST(Tracker, GivesTheSameBytesTwice) {
  Tracker a(small_config());
  Tracker b(small_config());
  for (int i = 0; i < 6; ++i)
    EXPECT_EQ(step(a, i).map_from_camera.matrix(), step(b, i).map_from_camera.matrix());
}

TEST(Tracker, ReadsAKeyframesPictureWhereItWasMovedTo) {
  Tracker tracker(small_config());
  const KeyframeId id = step(tracker, 0).keyframe->id;
  const Picture before = tracker.map().keyframe(id)->images;
  const auto copy = std::make_shared<const ImagePyramid>(before->level(0).clone(), before->levels());
  tracker.move_picture(id, copy, copy);
  EXPECT_EQ(tracker.map().keyframe(id)->images, before) << "not what it has: of a keyframe in another map";
  tracker.move_picture(id, before, copy);
  EXPECT_EQ(tracker.map().keyframe(id)->images, copy);
  tracker.move_picture(1000, before, copy);
  Tracker other(small_config());
  step(other, 0);
  for (int i = 1; i < 6; ++i)
    EXPECT_EQ(step(tracker, i).map_from_camera.matrix(), step(other, i).map_from_camera.matrix());
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
