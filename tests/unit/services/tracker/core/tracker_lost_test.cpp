// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using namespace test;

TEST(TrackerLost, InventsNoPoseWhenNothingIsSeenAndFindsBack) {
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

TEST(TrackerLost, FollowsPointsAgainAsSoonAsItHasFoundBack) {
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

TEST(TrackerLost, StaysLostWhereNothingIsKnown) {
  Tracker tracker(small_config());
  for (int i = 0; i < 6; ++i) step(tracker, i);
  for (int i = 6; i < 50; ++i) {
    const FrameResult elsewhere = tracker.track(picture_of_strips(test::pose(2.7, 2.4, 0), i * kFrameNs), {});
    EXPECT_EQ(elsewhere.state, State::kLost) << i;
    EXPECT_FALSE(elsewhere.keyframe) << i;
  }
  EXPECT_EQ(tracker.track(picture_of_strips(truth(4), 50 * kFrameNs), {}).state, State::kRelocalised);
}

bool gives_up(Tracker& tracker, int first, int frames) {
  for (int i = first; i < first + frames; ++i) tracker.track(test::dark_picture(i * kFrameNs), {});
  return tracker.has_lost_young_map((first + frames - 1) * kFrameNs);
}

TEST(TrackerLost, GivesUpAYoungMapAfterASecondOrAsLongAsItWasTracked) {
  const int second = static_cast<int>(1'000'000'000 / kFrameNs);
  Tracker brief(small_config());
  for (int i = 0; i < 6; ++i) step(brief, i);
  EXPECT_FALSE(brief.has_lost_young_map(5 * kFrameNs));
  EXPECT_FALSE(gives_up(brief, 6, second - 2));
  EXPECT_TRUE(gives_up(brief, 6 + second - 2, 4));
  brief.reset();
  EXPECT_EQ(step(brief, 8).state, State::kTracking);
  EXPECT_FALSE(gives_up(brief, 9, 3));

  Tracker paused(small_config());
  for (int i = 0; i < 6; ++i) step(paused, i);
  EXPECT_FALSE(gives_up(paused, 4 * second, second / 2)) << "was not looked for during the gap";
  EXPECT_TRUE(gives_up(paused, 4 * second + second / 2, second));

  TrackerConfig patient = small_config();
  patient.young_map_s = 0;
  Tracker never(patient);
  for (int i = 0; i < 6; ++i) step(never, i);
  EXPECT_FALSE(gives_up(never, 6, 3 * second));
}

TEST(TrackerLost, AJumpToAKnownPlaceIsSaidToBeOne) {
  Tracker tracker(small_config());
  for (int i = 0; i < 50; ++i) ASSERT_EQ(step(tracker, i).state, State::kTracking) << i;
  for (int i = 0; i < 6; ++i) {
    const FrameResult result = tracker.track(picture_of_strips(truth(3 + i), (50 + i) * kFrameNs), {});
    EXPECT_EQ(result.state, i == 0 ? State::kRelocalised : State::kTracking) << i;
    EXPECT_TRUE(error_m(result, 3 + i) < 0.02) << i << ": " << error_m(result, 3 + i);
  }
}

TEST(TrackerLost, SurvivesJumpsOfExposure) {
  Tracker tracker(small_config());
  for (int i = 0; i < 12; ++i) {
    image::RgbdFrame picture = picture_of_strips(truth(i), i * kFrameNs);
    picture.color.pixels *= i / 3 % 2 == 0 ? 0.9 : 0.45;
    const FrameResult result = tracker.track(picture, {});
    ASSERT_EQ(result.state, State::kTracking) << i;
    EXPECT_TRUE(error_m(result, i) < 0.015) << i << ": " << error_m(result, i);
  }
}

TEST(TrackerLost, TheEdgeOfWhatCoversTheLensDoesNotMoveTheCamera) {
  Tracker tracker(small_config());
  for (int i = 0; i < 24; ++i) {
    image::RgbdFrame picture = picture_of_wall(truth(i), i * kFrameNs);
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

TEST(TrackerLost, SurvivesBadPictures) {
  Tracker tracker(small_config());
  image::RgbdFrame empty;
  EXPECT_EQ(tracker.track(empty, {}).state, State::kNotInitialized);
  step(tracker, 0);
  EXPECT_EQ(tracker.track(empty, {}).state, State::kLost);
  image::RgbdFrame small_depth = picture_of_strips(truth(1), kFrameNs);
  small_depth.depth.values = cv::Mat(3, 3, CV_16UC1);
  EXPECT_EQ(tracker.track(small_depth, {}).state, State::kLost);
  image::RgbdFrame nan = picture_of_strips(truth(1), kFrameNs);
  nan.depth.values.setTo(std::numeric_limits<float>::quiet_NaN());
  tracker.track(nan, {});
  EXPECT_EQ(step(tracker, 2).state, State::kTracking);
}

}  // namespace
}  // namespace rds::tracker
