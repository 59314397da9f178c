// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "services/tracker/core/mapping/local_mapping.hpp"
#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using test::kFrameNs;
using test::small_config;
using test::step;
using ::testing::HasSubstr;

/// What a store does with rows.
struct Rows {
  std::map<std::string, std::map<std::uint64_t, map_file::Bytes>> by_kind;

  void take(std::vector<CheckpointRow> rows) {
    for (CheckpointRow& row : rows) {
      if (row.bytes)
        by_kind[row.kind][row.id] = std::move(*row.bytes);
      else
        by_kind[row.kind].erase(row.id);
    }
  }
  [[nodiscard]] ReadRows reader() const {
    return [this](const std::string& kind, const VisitRow& visit) -> tl::expected<void, std::string> {
      if (const auto rows = by_kind.find(kind); rows != by_kind.end())
        for (const auto& [id, bytes] : rows->second) visit(id, bytes);
      return {};
    };
  }
};

/// Every row of a map, at once.
Rows all_rows(SlamMap& map) {
  map.keyframes().for_each([](Keyframe&) {});
  map.records().all().for_each([](KeyframeRecord&) {});
  map.points().for_each([](MapPoint&) {});
  std::vector<CheckpointRow> told;
  MapCheckpoint().append_changes(map, told);
  Rows rows;
  rows.take(std::move(told));
  rows.by_kind.erase("map");
  return rows;
}

void map_locally(Tracker& tracker) {
  if (const auto job = tracker.take_mapping_job()) tracker.apply(run_local_mapping(*job));
}

/// A tracker that has made a map, and told it every third frame.
class CheckpointedTracker : public ::testing::Test {
 protected:
  CheckpointedTracker() {
    for (int i = 0; i < 24; ++i) {
      step(tracker, i);
      map_locally(tracker);
      if (i == 15) tracker.correct(correction());
      if (i % 3 == 2) rows.take(tracker.checkpoint());
    }
  }

  [[nodiscard]] std::vector<KeyframePose> correction() const {
    std::vector<KeyframePose> moved;
    for (const KeyframePose& k : tracker.keyframe_poses())
      moved.push_back({k.id, k.stamp_ns, test::pose(0, 0, 0.001) * k.map_from_camera});
    return moved;
  }

  Tracker tracker{small_config()};
  Rows rows;
};

TEST_F(CheckpointedTracker, TheSameMapComesOutOfTheChanges) {
  Tracker resumed(small_config());
  ASSERT_TRUE(resumed.resume(rows.reader()));
  EXPECT_GE(resumed.map().keyframes().size(), 3U);
  EXPECT_GT(resumed.map().points().size(), 200U);
  SlamMap again = *map_from_rows(rows.reader(), ScalePyramid(4, 1.2));
  EXPECT_EQ(all_rows(again).by_kind, [&] {
    auto told = rows.by_kind;
    told.erase("map");
    told.erase("camera");
    return told;
  }());
  const auto poses = tracker.keyframe_poses();
  const auto poses_again = resumed.keyframe_poses();
  ASSERT_EQ(poses_again.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_EQ(poses_again[i].map_from_camera.matrix(), poses[i].map_from_camera.matrix());
  tracker.map().points().for_each([&](const MapPoint& point) {
    const MapPoint* other = resumed.map().point(point.id);
    ASSERT_NE(other, nullptr);
    EXPECT_EQ(other->position, point.position);
    EXPECT_GT(other->found, 0U);
    EXPECT_LE(other->found, point.found) << "told when something else of its block had changed";
    EXPECT_EQ(other->observations.size(), point.observations.size());
  });
  EXPECT_EQ(resumed.calibration().readout_s(), tracker.calibration().readout_s());
  EXPECT_EQ(resumed.calibration().belief().information, tracker.calibration().belief().information);
}

TEST_F(CheckpointedTracker, WhatHasNotChangedIsNotToldAgain) {
  const auto nothing = tracker.checkpoint();
  for (const CheckpointRow& row : nothing) EXPECT_TRUE(row.kind == "map" || row.kind == "camera") << row.kind;
  Tracker resumed(small_config());
  ASSERT_TRUE(resumed.resume(rows.reader()));
  EXPECT_EQ(resumed.checkpoint().size(), nothing.size()) << "the rows it was read from are there";
}

TEST_F(CheckpointedTracker, ACameraThatStandsStillCostsNothing) {
  for (int i = 24; i < 40; ++i) step(tracker, 23);
  rows.take(tracker.checkpoint());
  for (int i = 0; i < 10; ++i)
    EXPECT_TRUE(has_pose(tracker.track(test::picture_of_strips(test::truth(23), (50 + i) * kFrameNs), {}).state));
  for (const CheckpointRow& row : tracker.checkpoint()) EXPECT_NE(row.kind, "points");
}

TEST_F(CheckpointedTracker, FindsItselfAndUsesNoIdTwice) {
  FrameResult last;
  for (int i = 24; i < 60; ++i) last = step(tracker, i);  // nobody knows of these any more
  const KeyframeId given = tracker.map().records().next_id();
  const PointId points_given = tracker.map().points().next_id();
  Tracker resumed(small_config());
  ASSERT_TRUE(resumed.resume(rows.reader()));
  EXPECT_EQ(resumed.track(test::dark_picture(61 * kFrameNs), {}).state, State::kLost);
  const FrameResult found = resumed.track(test::picture_of_strips(test::truth(14), 62 * kFrameNs), {});
  ASSERT_EQ(found.state, State::kRelocalised);
  EXPECT_LT(test::error_m(found, 14), 0.02);
  for (int i = 15; i < 40; ++i) {
    const FrameResult next = resumed.track(test::picture_of_strips(test::truth(i), (62 + i) * kFrameNs), {});
    EXPECT_TRUE(has_pose(next.state)) << i;
    if (next.keyframe) {
      EXPECT_GE(next.keyframe->id, given);
    }
    map_locally(resumed);
  }
  EXPECT_GT(resumed.map().records().next_id(), given);
  EXPECT_GT(resumed.map().points().next_id(), points_given);
  const auto poses = resumed.keyframe_poses();
  EXPECT_LT(poses.size(), 100U) << "ids that were left out have no pose";
}

TEST_F(CheckpointedTracker, GoesOnAfterASecondRestart) {
  Tracker second(small_config());
  ASSERT_TRUE(second.resume(rows.reader()));
  for (int i = 10; i < 30; ++i) {
    second.track(test::picture_of_strips(test::truth(i), (40 + i) * kFrameNs), {});
    map_locally(second);
  }
  rows.take(second.checkpoint());
  Tracker third(small_config());
  ASSERT_TRUE(third.resume(rows.reader()));
  EXPECT_EQ(third.map().keyframes().size(), second.map().keyframes().size());
  EXPECT_EQ(third.map().points().size(), second.map().points().size());
}

TEST_F(CheckpointedTracker, CulledKeyframesLeaveTheirPoseOnly) {
  SlamMap map = *map_from_rows(rows.reader(), ScalePyramid(4, 1.2));
  MapCheckpoint checkpoint;
  checkpoint.mark_written(map);
  const KeyframeId culled = 2;
  ASSERT_NE(map.keyframe(culled), nullptr);
  const Pose pose = map.pose_of(culled);
  map.cull_keyframe(culled);
  std::vector<CheckpointRow> told;
  checkpoint.append_changes(map, told);
  rows.take(std::move(told));
  EXPECT_FALSE(rows.by_kind["features"].contains(culled));
  const auto again = map_from_rows(rows.reader(), ScalePyramid(4, 1.2));
  ASSERT_TRUE(again) << again.error();
  EXPECT_EQ(again->keyframe(culled), nullptr);
  EXPECT_TRUE(again->pose_of(culled).isApprox(pose, 1e-12));
}

TEST_F(CheckpointedTracker, RowsThatAreCutShortOrMissingAreRefused) {
  Tracker resumed(small_config());
  for (const std::string kind : {"features", "keyframes", "points", "map", "camera"}) {
    Rows spoiled = rows;
    spoiled.by_kind[kind].begin()->second.pop_back();
    EXPECT_FALSE(resumed.resume(spoiled.reader())) << kind;
  }
  for (const std::string kind : {"features", "keyframes", "camera"}) {
    Rows spoiled = rows;
    spoiled.by_kind[kind].erase(spoiled.by_kind[kind].begin());
    EXPECT_FALSE(resumed.resume(spoiled.reader())) << kind;
  }
  EXPECT_EQ(step(resumed, 0).state, State::kTracking) << "as before";
}

TEST_F(CheckpointedTracker, AnotherPyramidIsRefused) {
  TrackerConfig config = small_config();
  config.extraction.levels = 3;
  const auto refused = Tracker(config).resume(rows.reader());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error(), HasSubstr("4 levels"));
}

TEST(MapContents, PosesThatHangOnNothingAreRefused) {
  for (const auto& anchors : {std::vector<KeyframeId>{1, 0}, {7, kNoId}, {0, kNoId}}) {
    IdTable<KeyframeRecord> records;
    for (KeyframeId id = 0; id < anchors.size(); ++id)
      records.emplace({id, 0, anchors[id], Pose::Identity()});
    MapContents contents;
    contents.records = KeyframeRecords(std::move(records), 0);
    EXPECT_FALSE(map_of(std::move(contents), ScalePyramid(8, 1.2)));
  }
}

}  // namespace
}  // namespace rds::tracker
