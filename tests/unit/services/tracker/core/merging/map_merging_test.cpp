// SPDX-License-Identifier: Apache-2.0
// Maps of two cameras that were carried past parts of one wall.
#include "services/tracker/core/merging/map_merging.hpp"

#include <cmath>

#include "services/tracker/core/merging/map_union.hpp"
#include "services/tracker/core/submaps/submap_joining.hpp"
#include "tests/unit/services/tracker/core/mapping/two_laps.hpp"
#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

using namespace test;
using ::testing::HasSubstr;

constexpr double kReliefM = 0.6;
constexpr double kStepM = 0.03;  // between two frames

/// From where a camera looks at the wall.
struct Way {
  double from_x = 0;
  double to_x = 0;
  double y = 0;
  double relief_m = kReliefM;
  geometry::CameraModel camera = small_camera();

  [[nodiscard]] int frames() const { return static_cast<int>(std::lround(std::abs(to_x - from_x) / kStepM)); }
  [[nodiscard]] Pose at(int frame) const {
    const double x = from_x + (to_x - from_x) * frame / frames();
    return pose(x, y + 0.05 * x, 0, 0.1 * x);
  }
};

/// Without what only lives in a tracker: as it is loaded.
SavedMap reloaded(const SlamMap& map, const KnownCamera& camera) {
  const auto extraction = small_config().extraction;
  auto loaded = map_from_bytes(to_bytes(map, camera, extraction), keyframe_poses(map), extraction);
  if (!loaded) throw std::runtime_error(loaded.error());
  return std::move(*loaded);
}

/// The saved map of a camera that went this way; stamps are numbers of frames.
SavedMap map_of(const Way& way) {
  Tracker tracker(small_config());
  for (int i = 0; i <= way.frames(); ++i) {
    tracker.track(picture_of_wall(way.at(i), i * kFrameNs, way.camera, way.relief_m), {});
    if (const auto job = tracker.take_mapping_job()) tracker.apply(run_local_mapping(*job));
  }
  return reloaded(tracker.map(), {way.camera.fx, 1});
}

/// Farthest that a keyframe lies from where it was, of those with ids from `first` on [m].
double worst_error_m(const SlamMap& map, const Way& way, const Pose& map_from_wall, KeyframeId first,
                     KeyframeId end) {
  double worst = 0;
  for (const KeyframePose& k : keyframe_poses(map, first)) {
    if (k.id >= end) break;
    const Pose truth = map_from_wall * way.at(static_cast<int>(k.stamp_ns / kFrameNs));
    worst = std::max(worst, (k.map_from_camera.translation() - truth.translation()).norm());
  }
  return worst;
}

class MapMerging : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    maps = std::make_unique<Maps>(Maps{map_of(kEarlierWay), map_of(kLaterWay)});
  }
  static void TearDownTestSuite() { maps.reset(); }

  static inline const Way kEarlierWay{0, 1.2};
  static inline const Way kLaterWay{2.4, 0.9};
  struct Maps {
    SavedMap earlier;
    SavedMap later;
  };
  static inline std::unique_ptr<Maps> maps;
};

TEST_F(MapMerging, TheLaterMapGoesToItsPlaceInTheFrameOfTheEarlierOne) {
  const auto merged = merge_maps(maps->earlier, maps->later);
  ASSERT_TRUE(merged) << merged.error();
  const MapJoint& joint = merged->joint;
  EXPECT_EQ(joint.searched, maps->later.map.keyframes().size());
  EXPECT_GE(joint.found, joint.agreeing);
  EXPECT_GE(joint.agreeing, kAgreeingSightings);
  EXPECT_GE(joint.inliers, 50 * joint.agreeing);
  EXPECT_GT(joint.fused, 50U);
  EXPECT_LT(joint.residual_m, 0.01);
  EXPECT_LT(joint.residual_rad, 0.01);
  const Pose wrong = joint.earlier_from_later.inverse() * kEarlierWay.at(0).inverse() * kLaterWay.at(0);
  EXPECT_LT(wrong.translation().norm(), 0.03);
  EXPECT_LT(geometry::rotation_angle_rad(wrong.linear()), 0.015);

  const SlamMap& map = merged->saved.map;
  const Pose map_from_wall = kEarlierWay.at(0).inverse();
  EXPECT_EQ(merged->first_of_later, maps->earlier.map.records().next_id());
  EXPECT_EQ(keyframe_poses(map).size(),
            keyframe_poses(maps->earlier.map).size() + keyframe_poses(maps->later.map).size());
  EXPECT_LT(worst_error_m(map, kLaterWay, map_from_wall, merged->first_of_later, kNoId), 0.04);
  EXPECT_EQ(merged->moved.size(), maps->later.map.keyframes().size());
}

TEST_F(MapMerging, NeitherMapIsChangedAndTheEarlierKeyframesStay) {
  const auto before = keyframe_poses(maps->earlier.map);
  const auto of_later = keyframe_poses(maps->later.map);
  const auto merged = merge_maps(maps->earlier, maps->later);
  ASSERT_TRUE(merged) << merged.error();
  const auto poses = keyframe_poses(merged->saved.map);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(poses[i].id, before[i].id);
    EXPECT_EQ(poses[i].map_from_camera.matrix(), before[i].map_from_camera.matrix());
  }
  for (std::size_t i = 0; i < of_later.size(); ++i)
    EXPECT_EQ(poses[before.size() + i].stamp_ns, of_later[i].stamp_ns);
  EXPECT_EQ(keyframe_poses(maps->later.map).front().map_from_camera.matrix(),
            of_later.front().map_from_camera.matrix());
}

TEST_F(MapMerging, TheSameMapsGiveTheSameBytesAndAreTrackedInFromEitherEnd) {
  const auto once = merge_maps(maps->earlier, maps->later);
  const auto again = merge_maps(maps->earlier, maps->later);
  ASSERT_TRUE(once && again);
  const auto extraction = small_config().extraction;
  EXPECT_EQ(to_bytes(once->saved.map, once->saved.camera, extraction),
            to_bytes(again->saved.map, again->saved.camera, extraction));

  TrackerConfig config = small_config();
  config.localize_only = true;
  Tracker tracker(config);
  tracker.start_from(reloaded(once->saved.map, once->saved.camera));
  std::int64_t time_ns = 0;
  for (const double x : {0.1, 2.3}) {
    const Way way{x, x + 10};
    const FrameResult found = tracker.track(picture_of_wall(way.at(0), time_ns, way.camera, kReliefM), {});
    EXPECT_EQ(found.state, State::kRelocalised) << x;
    const Pose truth = kEarlierWay.at(0).inverse() * way.at(0);
    EXPECT_LT((found.map_from_camera.translation() - truth.translation()).norm(), 0.04) << x;
    time_ns += 10 * kFrameNs;
    tracker.track(dark_picture(time_ns), {});
    time_ns += 100 * kFrameNs;
  }
}

TEST_F(MapMerging, ALaterMapThatHasDriftedIsJoinedAllTheWay) {
  const Way way{0, 1.8};
  const SavedMap earlier = map_of(way);
  SavedMap later = earlier;
  const auto drift_at = [](double x) { return pose(0, 0.07 * x, 0, 0.02 * x); };
  std::map<KeyframeId, Pose> drift;
  later.map.keyframes().for_each([&](Keyframe& k) {
    drift[k.id] = drift_at(k.map_from_camera.translation().x());
    k.map_from_camera = drift[k.id] * k.map_from_camera;
  });
  later.map.points().for_each([&](MapPoint& p) { p.position = drift.at(p.created_by) * p.position; });
  later.map.points().for_each([&](MapPoint& p) { update_view(later.map, p); });
  const Pose map_from_wall = way.at(0).inverse();
  ASSERT_GT(worst_error_m(later.map, way, map_from_wall, 0, kNoId), 0.12);

  const auto merged = merge_maps(earlier, later);
  ASSERT_TRUE(merged) << merged.error();
  EXPECT_LT(worst_error_m(merged->saved.map, way, map_from_wall, merged->first_of_later, kNoId), 0.04);
  EXPECT_GE(merged->joint.agreeing, merged->joint.found * 9 / 10);
}

TEST_F(MapMerging, MapsWithoutACommonPlaceAreRefused) {
  const auto merged = merge_maps(maps->earlier, map_of({0, 0.4, 2.6}));
  ASSERT_FALSE(merged);
  EXPECT_THAT(merged.error(), HasSubstr("keyframes were found, expected 3 that agree"));
}

TEST_F(MapMerging, WhatLiesInOnePlaneJoinsNothing) {
  const auto merged = merge_maps(map_of({0, 0.4, 0, 0}), map_of({0.2, 0.6, 0, 0}));
  ASSERT_FALSE(merged);
  EXPECT_THAT(merged.error(), HasSubstr("0 of its"));
}

TEST_F(MapMerging, MapsOfCamerasThatDoNotFitAreRefused) {
  geometry::CameraModel tele = small_camera();
  tele.fx = tele.fy = 400;
  const auto merged = merge_maps(maps->earlier, map_of({0, 0.2, 0, kReliefM, tele}));
  ASSERT_FALSE(merged);
  EXPECT_THAT(merged.error(), HasSubstr("focal length of 400.0 px, expected 320x240 and 300.0"));
}

TEST(MapUnion, CulledKeyframesOfTheLaterMapMoveWithTheOneBeforeThem) {
  TwoLaps laps(Pose::Identity());
  laps.map.cull_keyframe(3);
  const auto poses = keyframe_poses(laps.map);
  const ExtractionConfig extraction{1000, 8, 1.2, 20, 7};
  const auto saved = map_from_bytes(to_bytes(laps.map, {}, extraction), poses, extraction);
  ASSERT_TRUE(saved) << saved.error();
  auto both = unite(saved->map, saved->map);
  ASSERT_TRUE(both) << both.error();
  const KeyframeId first = saved->map.records().next_id();
  const auto of_later = keyframe_poses(*both, 0, kLaterMap);
  ASSERT_EQ(of_later.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(of_later[i].id, poses[i].id + first);
    EXPECT_TRUE(of_later[i].map_from_camera.isApprox(poses[i].map_from_camera, 1e-9));
  }
  EXPECT_EQ(keyframe_poses(*both).size(), poses.size()) << "what has no place yet is not in the map";

  const Pose moved = pose(1, 2, 3, 0.4);
  move_submap(*both, {kLaterMap, Submaps::kMap, moved});
  EXPECT_TRUE(both->pose_of(first + 3).isApprox(moved * poses[3].map_from_camera, 1e-9));
  EXPECT_EQ(both->pose_of(3).matrix(), poses[3].map_from_camera.matrix());
  EXPECT_EQ(keyframe_poses(*both).size(), 2 * poses.size());
  EXPECT_EQ(both->points().size(), 2 * saved->map.points().size());
}

}  // namespace
}  // namespace rds::tracker
