// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/map_building.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

class MapBuilding : public ::testing::Test {
 protected:
  TrackedFrame frame_at(const Pose& map_from_camera) {
    TrackedFrame frame;
    frame.camera_from_map = map_from_camera.inverse();
    view = test::view_of(points, map_from_camera, 0, random);
    frame.features = view.features;
    frame.clear_matches();
    return frame;
  }

  /// A keyframe whose frame sees again what the map knows.
  Keyframe& add(const Pose& map_from_camera) {
    TrackedFrame frame = frame_at(map_from_camera);
    for (std::size_t f = 0; f < view.point.size(); ++f) frame.points[f] = known[view.point[f]];
    Keyframe& keyframe = insert_keyframe(map, frame, DepthConfig{});
    for (std::size_t f = 0; f < view.point.size(); ++f) known[view.point[f]] = keyframe.points[f];
    return keyframe;
  }

  std::mt19937 random{4};
  std::vector<Eigen::Vector3d> points = test::random_points(600, random);
  std::vector<PointId> known = std::vector<PointId>(600, kNoId);
  test::SyntheticView view;
  SlamMap map{ScalePyramid(8, 1.2)};
};

TEST_F(MapBuilding, AKeyframeMakesPointsOfItsCloseDepth) {
  const Keyframe& keyframe = add(Pose::Identity());
  EXPECT_EQ(map.points().size(), view.point.size());
  for (std::size_t f = 0; f < view.point.size(); ++f)
    EXPECT_TRUE((map.point(keyframe.points[f])->position - points[view.point[f]]).norm() < 1e-3);
}

/// As in a doorway: what is near leaves the picture, and the room behind it has to be known by then.
TEST_F(MapBuilding, AKeyframeMakesPointsOfFarDepthWhereLittleIsNear) {
  for (std::size_t p = 150; p < points.size(); ++p) points[p] *= 3;  // 4.5 … 9 m away
  const Keyframe& keyframe = add(Pose::Identity());
  const auto far = [&](std::size_t f) { return view.point[f] >= 150; };
  std::size_t made = 0;
  for (std::size_t f = 0; f < view.point.size(); ++f) made += far(f) && keyframe.points[f] != kNoId ? 1 : 0;
  EXPECT_GE(made, 250U);
  EXPECT_GE(map.points().size(), 400U);
}

/// Somebody who comes near hides the close ones at once.
TEST_F(MapBuilding, AKeyframeMakesFarPointsWhereThePictureHasNoCloseOnes) {
  points = test::random_points(3000, random);
  known.assign(points.size(), kNoId);
  const auto far = [&](std::size_t f) { return points[view.point[f]].x() > 0; };
  for (Eigen::Vector3d& p : points)
    if (p.x() > 0) p *= 3;
  const Keyframe& keyframe = add(Pose::Identity());
  std::size_t close = 0;
  std::size_t all_far = 0;
  std::size_t made = 0;
  for (std::size_t f = 0; f < view.point.size(); ++f) {
    close += far(f) ? 0 : 1;
    all_far += far(f) ? 1 : 0;
    made += far(f) && keyframe.points[f] != kNoId ? 1 : 0;
  }
  EXPECT_GT(close, 400U);
  EXPECT_GE(made, 50U);
  EXPECT_LT(made, all_far / 2);
}

TEST_F(MapBuilding, PointsSeenOnceAreCulledTwoKeyframesOn) {
  add(Pose::Identity());
  std::vector<PointId> recent{known[view.point[0]], known[view.point[1]]};
  const PointId seen_again = recent[0];
  const PointId seen_once = recent[1];
  map.observe(seen_again, 0, 0);
  for (int k = 1; k <= 2; ++k) {
    TrackedFrame frame = frame_at(test::pose(0.01 * k, 0, 0));
    frame.points[0] = seen_again;
    insert_keyframe(map, frame, DepthConfig{});
  }
  cull_recent_points(map, 2, recent);
  EXPECT_NE(map.point(seen_again), nullptr);
  EXPECT_EQ(map.point(seen_once), nullptr);
  EXPECT_EQ(recent, std::vector<PointId>{seen_again});
}

TEST_F(MapBuilding, RedundantKeyframesGoTheFirstAndTheNewestStay) {
  for (int k = 0; k < 9; ++k) add(test::pose(0.005 * k, 0, 0));
  const auto culled = cull_redundant_keyframes(map, 8, DepthConfig{});
  EXPECT_FALSE(culled.empty());
  for (const KeyframeId kept : {0U, 6U, 7U, 8U}) EXPECT_NE(map.keyframe(kept), nullptr) << kept;
  for (const KeyframeId k : culled)
    EXPECT_TRUE(map.pose_of(k).isApprox(test::pose(0.005 * static_cast<double>(k), 0, 0), 1e-9));
}

TEST_F(MapBuilding, LateBoxesTakeBackWhatTheKeyframeMadeInThem) {
  add(Pose::Identity());
  const Keyframe& second = add(test::pose(0.3, 0, 0));
  const MovableMask movable = test::mask_of({0, 0, 160, 240});
  std::vector<PointId> made, older, outside;
  for (std::size_t f = 0; f < second.points.size(); ++f) {
    const Feature& feature = (*second.features)[f];
    auto& list = !movable.covers(feature.image_px)                      ? outside
                 : map.point(second.points[f])->created_by == second.id ? made
                                                                        : older;
    list.push_back(second.points[f]);
  }
  ASSERT_FALSE(older.empty());
  ASSERT_FALSE(outside.empty());
  retract_movable(map, second.id, movable, DepthConfig{});
  for (const PointId p : made) EXPECT_EQ(map.point(p), nullptr);
  for (const PointId p : older) {
    ASSERT_NE(map.point(p), nullptr);
    EXPECT_EQ(map.point(p)->observations.size(), 1U);
  }
  for (const PointId p : outside) EXPECT_NE(map.point(p), nullptr);
  retract_movable(map, 99, movable, DepthConfig{});  // unknown: ignored
}

}  // namespace
}  // namespace rds::tracker
