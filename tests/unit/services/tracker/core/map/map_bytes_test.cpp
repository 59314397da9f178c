// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/map_bytes.hpp"

#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using ::testing::HasSubstr;

const KnownCamera kCamera{test::small_camera().fx, 1};

using test::kFrameNs;
using test::truth;

TrackerConfig small_config(bool localize_only = false) {
  TrackerConfig config = test::small_config();
  config.localize_only = localize_only;
  return config;
}

constexpr double kReliefM = 0.6;  // no place is recognised by one plane

FrameResult step(Tracker& tracker, int frame, std::int64_t stamp_ns) {
  return tracker.track(test::picture_of_wall(truth(frame), stamp_ns, test::small_camera(), kReliefM), {});
}

/// A map of a dozen frames, and its bytes.
class SavedTracker : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    Tracker tracker(small_config());
    for (int i = 0; i < 12; ++i) step(tracker, i, 1'000'000'000'000 + i * kFrameNs);
    bytes = bytes_of(tracker.map());
    poses = keyframe_poses(tracker.map());
  }

  static map_file::Bytes bytes_of(const SlamMap& map) {
    return to_bytes(map, kCamera, small_config().extraction);
  }

  static SavedMap load() {
    auto map = map_from_bytes(bytes, poses, small_config().extraction);
    if (!map) throw std::runtime_error(map.error());
    return std::move(*map);
  }

  static Tracker start(bool localize_only = false) {
    Tracker tracker(small_config(localize_only));
    tracker.start_from(load());
    return tracker;
  }

  static inline map_file::Bytes bytes;
  static inline std::vector<KeyframePose> poses;
};

TEST_F(SavedTracker, TheSameBytesComeOutOfALoadedMap) {
  const SlamMap map = load().map;
  EXPECT_GT(map.keyframes().size(), 1U);
  EXPECT_GT(map.points().size(), 200U);
  EXPECT_EQ(bytes_of(map), bytes);
  for (const KeyframePose& k : poses) EXPECT_EQ(map.pose_of(k.id).matrix(), k.map_from_camera.matrix());
  EXPECT_FALSE(map.keyframe(0)->covisible.empty());
}

TEST_F(SavedTracker, CulledKeyframesKeepIdAndPose) {
  SlamMap map = load().map;
  const KeyframeId culled = map.records().next_id() - 1;
  const Pose turned(Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, -2, .5).normalized()));  // as level maps are
  for (const KeyframePose& k : poses) set_pose(map, k.id, turned * k.map_from_camera);
  map.cull_keyframe(culled);
  const Pose pose = map.pose_of(culled);
  const auto again = map_from_bytes(bytes_of(map), keyframe_poses(map), small_config().extraction);
  ASSERT_TRUE(again) << again.error();
  EXPECT_EQ(again->map.keyframe(culled), nullptr);
  EXPECT_EQ(again->map.pose_of(culled).matrix(), pose.matrix()) << "to the bit: a saved map stays as it is";
  EXPECT_EQ(again->map.records().next_id(), culled + 1);
}

TEST_F(SavedTracker, IsLostUntilItFindsItselfAndCountsOn) {
  Tracker tracker = start();
  EXPECT_EQ(tracker.track(test::dark_picture(0), {}).state, State::kLost);
  const FrameResult found =
      step(tracker, 6, kFrameNs);  // an earlier time than the map's: stamps mean nothing across maps
  ASSERT_EQ(found.state, State::kRelocalised);
  const Pose expected = truth(0).inverse() * truth(6);
  EXPECT_TRUE((found.map_from_camera.translation() - expected.translation()).norm() < 0.02);
  ASSERT_TRUE(found.keyframe) << "the mapper and the detector need to see where we are";
  EXPECT_EQ(found.keyframe->id, poses.size());
  for (int i = 7; i < 14; ++i) EXPECT_EQ(step(tracker, i, i * kFrameNs).state, State::kTracking);
  ASSERT_FALSE(tracker.keyframe_poses().empty());
  EXPECT_EQ(tracker.keyframe_poses().front().id, poses.size()) << "only keyframes of this epoch";
}

TEST_F(SavedTracker, TheLoadedMapIsTheGauge) {
  Tracker tracker = start();
  for (int i = 2; i < 16; ++i) {
    step(tracker, i, i * kFrameNs);
    if (const auto job = tracker.take_mapping_job()) {
      for (const MappingKeyframe& k : job->keyframes) EXPECT_TRUE(k.fixed || k.id >= poses.size()) << k.id;
      tracker.apply(run_local_mapping(*job));
    }
  }
  std::vector<KeyframePose> correction;
  for (const KeyframePose& k : keyframe_poses(tracker.map()))
    correction.push_back({k.id, k.stamp_ns, test::pose(0, 0, 0.1) * k.map_from_camera});
  const Pose last = tracker.keyframe_poses().back().map_from_camera;
  tracker.correct(correction);
  EXPECT_FALSE(tracker.keyframe_poses().back().map_from_camera.isApprox(last, 1e-3))
      << "new keyframes do move";
  for (const KeyframePose& k : poses)
    EXPECT_EQ(tracker.map().pose_of(k.id).matrix(), k.map_from_camera.matrix()) << k.id;
}

/// Steps, with local mapping beside.
FrameResult step_and_map(Tracker& tracker, int frame, std::int64_t stamp_ns) {
  const FrameResult result = step(tracker, frame, stamp_ns);
  if (const auto job = tracker.take_mapping_job()) tracker.apply(run_local_mapping(*job));
  return result;
}

TEST_F(SavedTracker, LocalizeOnlyStillChoosesKeyframes) {
  Tracker tracker = start(true);
  std::vector<std::uint64_t> shown;
  for (int i = 0; i < 30; ++i) {
    const FrameResult result = step_and_map(tracker, i % 12, i * kFrameNs);
    EXPECT_TRUE(has_pose(result.state)) << i;
    if (result.keyframe) shown.push_back(result.keyframe->id);
  }
  ASSERT_GE(shown.size(), 2U) << "at least one a second";
  EXPECT_EQ(shown.front(), poses.size());
  EXPECT_TRUE(std::ranges::is_sorted(shown));
  EXPECT_EQ(tracker.keyframe_poses().size(), shown.size());
}

TEST_F(SavedTracker, LocalizeOnlyTracksOnWhereTheMapEndsAndForgetsThatAgain) {
  constexpr int kFurthest = 60;
  Tracker tracker = start(true);
  std::size_t most = 0;
  for (int i = 0; i < 4 * kFurthest; ++i) {
    const int there = i % (2 * kFurthest);  // beyond the saved frames, and back
    const int frame = there < kFurthest ? there : 2 * kFurthest - there;
    const FrameResult result = step_and_map(tracker, frame, i * kFrameNs);
    ASSERT_TRUE(has_pose(result.state)) << i;
    EXPECT_LT(
        (result.map_from_camera.translation() - (truth(0).inverse() * truth(frame)).translation()).norm(),
        0.05)
        << i;
    most = std::max(most, tracker.map().keyframes().size() - load().map.keyframes().size());
  }
  EXPECT_GT(most, 3U);
  EXPECT_LE(most, 60U);
  for (const KeyframePose& k : poses)
    EXPECT_EQ(tracker.map().pose_of(k.id).matrix(), k.map_from_camera.matrix()) << "the gauge stays " << k.id;
}

TEST_F(SavedTracker, LocalizeOnlyWithoutAMapInventsNone) {
  Tracker tracker(small_config(true));
  EXPECT_EQ(step(tracker, 0, 0).state, State::kNotInitialized);
  EXPECT_EQ(tracker.map().keyframes().size(), 0U);
}

TEST_F(SavedTracker, AnEmptyMapStartsAtTheOrigin) {
  const Tracker nothing(small_config());
  auto map = map_from_bytes(bytes_of(nothing.map()), {}, small_config().extraction);
  ASSERT_TRUE(map) << map.error();
  Tracker tracker(small_config());
  tracker.start_from(std::move(*map));
  EXPECT_EQ(step(tracker, 0, 0).state, State::kTracking);
}

TEST_F(SavedTracker, TornBytesAreRefused) {
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 40)
    EXPECT_FALSE(map_from_bytes(std::span(bytes).first(size), poses, small_config().extraction)) << size;
}

TEST_F(SavedTracker, AlteredBytesDoNoHarm) {
  for (std::size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 15) {
    map_file::Bytes altered = bytes;
    altered[at] = static_cast<std::uint8_t>(~altered[at]);
    if (auto map = map_from_bytes(altered, poses, small_config().extraction)) {
      Tracker tracker(small_config());
      tracker.start_from(std::move(*map));
      step(tracker, 6, 0);
    }
  }
}

TEST_F(SavedTracker, WhatIsKnownOfTheCameraIsKnownAgainUnlessItIsAnother) {
  const KnownCamera camera{test::small_camera().fx, 0.97};
  auto saved = map_from_bytes(to_bytes(load().map, camera, small_config().extraction), poses,
                              small_config().extraction);
  ASSERT_TRUE(saved) << saved.error();
  Tracker tracker(small_config());
  tracker.start_from(std::move(*saved));
  step(tracker, 6, 0);
  EXPECT_EQ(tracker.calibration().known_camera().focal_scale, 0.97);
  image::RgbdFrame of_another = test::picture_of_wall(truth(7), kFrameNs);
  of_another.camera.fx *= 1.05;
  tracker.track(of_another, {});
  EXPECT_EQ(tracker.calibration().known_camera().given_fx, of_another.camera.fx);
  EXPECT_EQ(tracker.calibration().known_camera().focal_scale, 1);
}

TEST_F(SavedTracker, KeyframesOfAnotherCameraKeepTheirs) {
  Tracker tracker = start();
  for (int i = 2; i < 16; ++i) step(tracker, i, i * kFrameNs);
  const auto job = tracker.take_mapping_job();
  ASSERT_TRUE(job);
  for (const MappingKeyframe& k : job->keyframes)
    EXPECT_EQ(k.given_fx, k.id < poses.size() ? 0 : test::small_camera().fx) << k.id;
}

TEST_F(SavedTracker, SaysWhatDoesNotFit) {
  TrackerConfig other = small_config();
  other.extraction.levels = 8;
  EXPECT_THAT(map_from_bytes(bytes, poses, other.extraction).error(),
              HasSubstr("features of 4 levels with factor 1.2, expected 8"));
  const auto some = std::span(poses).first(poses.size() - 1);
  EXPECT_THAT(map_from_bytes(bytes, some, small_config().extraction).error(), HasSubstr("keyframe"));
}

}  // namespace
}  // namespace rds::tracker
