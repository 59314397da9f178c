// SPDX-License-Identifier: Apache-2.0
// A camera that is lost in an unknown place maps it beside the map, until it knows where it is.
#include <optional>
#include <utility>

#include "services/tracker/core/mapping/global_adjustment.hpp"
#include "services/tracker/core/submaps/submap_fit.hpp"
#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using namespace test;

constexpr double kFarX = 2.7;  // along the wall, where nothing shows that the map has
constexpr double kReliefM = 0.6;
constexpr int kCovered = 10;  // frames of a covered lens

TrackerConfig config() {
  TrackerConfig config = small_config();
  config.young_map_s = 0;
  config.submap_after_s = 0.3;
  return config;
}

/// A camera that is carried along the wall.
struct Walk {
  Pose pose_at(double x) const { return test::pose(x, 0.1 * x, 0, 0); }

  FrameResult look(const Pose& from) {
    at = from;
    const FrameResult result = tracker.track(picture_of_wall(from, time_ns, small_camera(), relief_m), {});
    map_locally();
    if (const auto now = tracker.join_submaps()) joined = now;
    if (auto job = tracker.take_adjustment_job())
      if (const auto adjusted = run_global_adjustment(*job, {})) tracker.apply_adjustment(*adjusted);
    time_ns += kFrameNs;
    return result;
  }
  FrameResult cover(int frames = kCovered) {
    FrameResult result;
    for (int i = 0; i < frames; ++i, time_ns += kFrameNs) result = tracker.track(dark_picture(time_ns), {});
    return result;
  }
  /// Maps half a metre, and is uncovered where the map shows nothing of.
  FrameResult begin_submap() {
    look(pose_at(0));
    go(0, 0.5, 20);
    cover();
    return look(pose_at(kFarX));
  }
  FrameResult go(double from_x, double to_x, int frames) {
    FrameResult result;
    for (int i = 1; i <= frames; ++i) result = look(pose_at(from_x + (to_x - from_x) * i / frames));
    return result;
  }
  void map_locally() {
    if (const auto job = tracker.take_mapping_job()) tracker.apply(run_local_mapping(*job));
  }
  /// Of the camera's newest pose, in the frame of the first picture.
  double error_m() const {
    const Pose expected = pose_at(0).inverse() * at;
    return (tracker.last_map_from_camera().translation() - expected.translation()).norm();
  }

  double relief_m = kReliefM;
  Tracker tracker{config()};
  std::int64_t time_ns = 0;
  Pose at = Pose::Identity();
  std::optional<JoinedSubmap> joined;
};

TEST(TrackerSubmap, BeginsWhereNothingIsKnownAndIsJoinedWhereTheMapIsSeenAgain) {
  Walk walk;
  walk.look(walk.pose_at(0));
  EXPECT_EQ(walk.go(0, 0.5, 20).submap, Submaps::kMap);
  EXPECT_EQ(walk.cover().state, State::kLost);

  const FrameResult first = walk.look(walk.pose_at(kFarX));
  EXPECT_EQ(first.state, State::kRelocalised);
  EXPECT_TRUE(first.begins_submap);
  EXPECT_EQ(first.submap, 1U);
  ASSERT_TRUE(first.keyframe);
  const FrameResult beside = walk.go(kFarX, kFarX - 0.5, 20);
  EXPECT_EQ(beside.state, State::kTracking);
  EXPECT_FALSE(beside.begins_submap);
  EXPECT_EQ(beside.submap, 1U);
  EXPECT_FALSE(walk.joined);
  const std::size_t in_map = walk.tracker.keyframe_poses().size();
  const std::size_t in_submap = walk.tracker.keyframe_poses(1).size();
  EXPECT_GT(in_submap, 1U);
  EXPECT_LT(walk.tracker.keyframe_poses().back().id, walk.tracker.keyframe_poses(1).front().id);

  const FrameResult back = walk.go(kFarX - 0.5, 0, 80);
  ASSERT_TRUE(walk.joined);
  EXPECT_EQ(walk.joined->submap, 1U);
  EXPECT_GT(walk.joined->placed.size(), 1U);
  EXPECT_EQ(walk.joined->placed.front(), first.keyframe->id);
  EXPECT_EQ(back.submap, Submaps::kMap);
  EXPECT_TRUE(walk.tracker.keyframe_poses(1).empty());
  EXPECT_GE(walk.tracker.keyframe_poses().size(), in_map + in_submap);
  EXPECT_LT(walk.error_m(), 0.03);
  walk.go(0, kFarX, 80);
  EXPECT_LT(walk.error_m(), 0.05) << "the joined part lies where it is";
}

TEST(TrackerSubmap, IsLeftWhereTheCameraFindsItselfInTheMapAndJoinedLater) {
  Walk walk;
  walk.begin_submap();
  EXPECT_EQ(walk.go(kFarX, kFarX - 0.4, 15).submap, 1U);
  walk.cover();
  const FrameResult found = walk.look(walk.pose_at(0.2));
  EXPECT_EQ(found.state, State::kRelocalised);
  EXPECT_EQ(found.submap, Submaps::kMap);
  EXPECT_LT(walk.error_m(), 0.02);
  EXPECT_EQ(walk.go(0.2, kFarX, 80).submap, Submaps::kMap);
  ASSERT_TRUE(walk.joined);
  EXPECT_EQ(walk.joined->submap, 1U) << "the map moves nowhere, the submap goes to it";
  EXPECT_LT(walk.error_m(), 0.05);
}

/// It may be found again by people, who walk on.
TEST(TrackerSubmap, IsGivenUpWhereTheCameraIsLostBeforeAnyPointIsKnownToBeStatic) {
  for (const int tracked : {5, 40}) {  // frames
    Walk walk;
    walk.begin_submap();
    const double there = kFarX + 0.005 * tracked;
    EXPECT_EQ(walk.go(kFarX, there, tracked).submap, 1U);
    EXPECT_EQ(walk.cover(5).state, State::kLost);
    EXPECT_EQ(walk.go(there, there + 0.1, 10).submap, tracked == 5 ? 2U : 1U);
  }
}

TEST(TrackerSubmap, IsNotJoinedByWhatLiesInOnePlane) {
  Walk walk;
  walk.relief_m = 0;
  walk.begin_submap();
  EXPECT_EQ(walk.go(kFarX, 0, 100).submap, 1U);
  EXPECT_FALSE(walk.joined);
}

TEST(TrackerSubmap, WhatWasMeasuredContradictsAWrongPlace) {
  Walk walk;
  walk.relief_m = 0;  // so that it is not joined
  walk.begin_submap();
  walk.go(kFarX, 0, 100);
  const SubmapMove right{1, Submaps::kMap, walk.pose_at(0).inverse() * walk.pose_at(kFarX)};
  const SubmapFit fit = fit_of(walk.tracker.map(), right);
  EXPECT_GT(fit.agree, 1000);
  EXPECT_TRUE(fits(walk.tracker.map(), right)) << fit.contradict;
  SubmapMove wrong = right;
  wrong.into_from_moved = test::pose(0, 0, 0.5) * right.into_from_moved;
  EXPECT_GT(fit_of(walk.tracker.map(), wrong).contradict, 1000);
  EXPECT_FALSE(fits(walk.tracker.map(), wrong));
}

TEST(TrackerSubmap, IsNotSavedButGoesOnAfterARestart) {
  Walk walk;
  walk.begin_submap();
  walk.go(kFarX, kFarX - 0.4, 15);
  const auto saved = map_from_bytes(to_bytes(walk.tracker.map(), {}, config().extraction),
                                    walk.tracker.keyframe_poses(), config().extraction);
  ASSERT_TRUE(saved) << saved.error();
  saved->map.keyframes().for_each(
      [&](const Keyframe& k) { EXPECT_TRUE(walk.tracker.map().records().is_placed(k.id)) << k.id; });

  std::map<std::string, std::map<std::uint64_t, map_file::Bytes>> rows;
  for (auto& row : walk.tracker.checkpoint())
    if (row.bytes) rows[row.kind][row.id] = std::move(*row.bytes);
  const ReadRows read = [&](const std::string& kind,
                            const VisitRow& visit) -> tl::expected<void, std::string> {
    for (const auto& [id, bytes] : rows[kind]) visit(id, bytes);
    return {};
  };
  ASSERT_TRUE(walk.tracker.resume(read));
  const FrameResult found = walk.look(walk.pose_at(kFarX - 0.4));
  EXPECT_EQ(found.state, State::kRelocalised);
  EXPECT_EQ(found.submap, 1U);
}

TEST(TrackerSubmap, BeginsNeitherInAYoungMapNorWhereItIsSwitchedOff) {
  for (const bool is_young : {true, false}) {
    TrackerConfig settings = config();
    if (is_young)
      settings.young_map_s = 60;
    else
      settings.submap_after_s = 0;
    Walk walk;
    walk.tracker = Tracker(settings);
    walk.look(walk.pose_at(0));
    walk.go(0, 0.2, 8);
    walk.cover();
    EXPECT_EQ(walk.look(walk.pose_at(kFarX)).state, State::kLost);
  }
}

}  // namespace
}  // namespace rds::tracker
