// SPDX-License-Identifier: Apache-2.0
// A camera whose depth fails on the way.
#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using namespace test;

constexpr int kWithDepth = 10;   // frames, from the first on
constexpr int kFrames = 110;     // 2.2 m along the wall: nothing of what had depth is in the last picture
constexpr int kMappingAfter = 2;  // frames until a result is applied

Pose along_the_wall(int frame) { return pose(0.02 * frame, 0.003 * frame, 0, 0); }

struct Passed {
  int tracked = 0;
  int keyframes = 0;  // without depth
  double error_m = 0;  // of the last frame that was tracked
};

Passed pass(const TrackerConfig& config) {
  Tracker tracker(config);
  Passed passed;
  std::optional<LocalMappingResult> mapped;
  int mapped_at = 0;
  for (int i = 0; i < kFrames; ++i) {
    image::RgbdFrame frame = picture_of_strips(along_the_wall(i), i * kFrameNs);
    if (i >= kWithDepth) frame.depth.values.setTo(0);
    if (mapped && i >= mapped_at + kMappingAfter) {
      tracker.apply(*mapped);
      mapped.reset();
    }
    const FrameResult result = tracker.track(frame, {});
    if (has_pose(result.state)) {
      ++passed.tracked;
      passed.error_m = (result.map_from_camera.translation() - along_the_wall(i).translation()).norm();
    }
    passed.keyframes += i >= kWithDepth && result.keyframe ? 1 : 0;
    if (!result.keyframe || mapped) continue;
    if (const auto job = tracker.take_mapping_job()) mapped = run_local_mapping(*job);
    mapped_at = i;
  }
  return passed;
}

TEST(TrackerDepthGap, GoesOnByPointsThatItTriangulates) {
  const Passed passed = pass(small_config());
  EXPECT_EQ(passed.tracked, kFrames);
  EXPECT_GT(passed.keyframes, 3);
  EXPECT_LT(passed.error_m, 0.05);
}

TEST(TrackerDepthGap, IsLostWithoutThem) {
  TrackerConfig config = small_config();
  config.depth.triangulate = false;
  const Passed passed = pass(config);
  EXPECT_LT(passed.tracked, kFrames - 20);
  EXPECT_EQ(passed.keyframes, 0);
}

TEST(TrackerDepthGap, NoMapBeginsWithoutDepth) {
  Tracker tracker(small_config());
  image::RgbdFrame frame = picture_of_strips(Pose::Identity(), 0);
  frame.depth.values.setTo(0);
  EXPECT_EQ(tracker.track(frame, {}).state, State::kNotInitialized);
}

}  // namespace
}  // namespace rds::tracker
