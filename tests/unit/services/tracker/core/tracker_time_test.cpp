// SPDX-License-Identifier: Apache-2.0
// Stamps that jump: a clock that was set, a recording that begins again.
#include <algorithm>

#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using namespace test;

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kStart = 2000 * kSecond;

FrameResult step_at(Tracker& tracker, int frame, std::int64_t stamp_ns) {
  return tracker.track(picture_of_strips(truth(frame), stamp_ns), {});
}

constexpr std::int64_t kSlowNs = 300'000'000;

/// A camera that stands for `frames` from this stamp on. @return keyframes.
int keyframes_standing_at(Tracker& tracker, int frame, std::int64_t stamp_ns, int frames,
                          std::int64_t interval_ns = kFrameNs) {
  int keyframes = 0;
  for (int i = 0; i < frames; ++i) {
    const FrameResult result = step_at(tracker, frame, stamp_ns + i * interval_ns);
    EXPECT_TRUE(has_pose(result.state)) << i;
    EXPECT_TRUE(error_m(result, frame) < 0.02) << i << ": " << error_m(result, frame);
    keyframes += result.keyframe ? 1 : 0;
  }
  return keyframes;
}

TEST(TrackerTime, KeyframesGoOnWithinASecondWhereStampsGoBack) {
  Tracker tracker(small_config());
  for (int i = 0; i < 10; ++i) step_at(tracker, i, kStart + i * kFrameNs);
  EXPECT_GE(keyframes_standing_at(tracker, 9, kStart - 1000 * kSecond, 17), 1);
}

TEST(TrackerTime, IsRelocalisedWhereStampsGoBackThenTracksOn) {
  Tracker tracker(small_config());
  for (int i = 0; i < 10; ++i) step_at(tracker, i, kStart + i * kFrameNs);
  EXPECT_EQ(step_at(tracker, 10, 5 * kSecond).state, State::kRelocalised);
  for (int i = 11; i < 20; ++i) {
    const FrameResult result = step_at(tracker, i, 5 * kSecond + (i - 10) * kFrameNs);
    EXPECT_EQ(result.state, State::kTracking) << i;
    EXPECT_TRUE(error_m(result, i) < 0.02) << i << ": " << error_m(result, i);
  }
}

TEST(TrackerTime, KeyframesGoOnAfterOneFrameFarAhead) {
  Tracker tracker(small_config());
  for (int i = 0; i < 16; ++i) step_at(tracker, std::min(i, 9), kStart + i * kFrameNs);
  EXPECT_TRUE(step_at(tracker, 9, kStart + 1000 * kSecond).keyframe);
  EXPECT_GE(keyframes_standing_at(tracker, 9, kStart + 17 * kFrameNs, 17), 1);
}

TEST(TrackerTime, ARecordingThatBeginsAgainIsTrackedInEachLap) {
  Tracker tracker(small_config());
  for (int lap = 0; lap < 3; ++lap) {
    int keyframes = 0;
    for (int i = 0; i < 30; ++i) {
      const FrameResult result = step_at(tracker, i, kStart + i * kFrameNs);
      EXPECT_TRUE(has_pose(result.state)) << lap << ", " << i;
      EXPECT_TRUE(error_m(result, i) < 0.03) << lap << ", " << i << ": " << error_m(result, i);
      keyframes += result.keyframe ? 1 : 0;
      EXPECT_TRUE(!result.keyframe || result.keyframe->stamp_ns == kStart + i * kFrameNs);
    }
    EXPECT_GE(keyframes, 2) << lap;
  }
}

TEST(TrackerTime, WhatHasBeenInViewForLongIsKnownAfterStampsWentBack) {
  Tracker tracker(small_config());
  keyframes_standing_at(tracker, 0, kStart, 25, kSlowNs);
  const std::size_t known = tracker.map().keyframes().size();
  int keyframes = 0;
  for (int i = 0; i < 20; ++i)
    keyframes += step_at(tracker, std::min(i, 20 - i), kFrameNs * i).keyframe ? 1 : 0;
  EXPECT_GE(keyframes, 1);
  EXPECT_LE(tracker.map().keyframes().size(), known + 1);
}

TEST(TrackerTime, AMapOfTheFutureIsGoneOnIn) {
  Tracker first(small_config());
  for (int i = 0; i < 30; ++i) step_at(first, i, kStart + i * kFrameNs);
  SlamMap saved = first.map();
  saved.records().fix_all();
  Tracker second(small_config());
  second.start_from({std::move(saved), first.calibration().known_camera()});
  const std::size_t known = second.map().keyframes().size();
  EXPECT_EQ(step_at(second, 5, 5 * kSecond).state, State::kRelocalised);
  keyframes_standing_at(second, 5, 5 * kSecond + kFrameNs, 20, kSlowNs);
  for (int i = 6; i < 30; ++i) step_at(second, i, 12 * kSecond + i * kFrameNs);
  EXPECT_LE(second.map().keyframes().size(), known + 1);
}

}  // namespace
}  // namespace rds::tracker
