// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/slam_map.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <malloc.h>

#include "services/tracker/core/map/covisibility.hpp"
#include "services/tracker/core/mapping/mapping_exchange.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

/// Four keyframes side by side that all see the same forty points.
class SlamMapTest : public ::testing::Test {
 protected:
  SlamMapTest() {
    std::mt19937 random(2);
    const auto points = test::random_points(400, random);
    for (int k = 0; k < 4; ++k) {
      const auto view = test::view_of(points, place(k), 0, random);
      const KeyframeId id = map.add_keyframe(1000 + k, place(k), view.features).id;
      for (std::uint32_t f = 0; f < view.point.size(); ++f) {
        const std::size_t p = view.point[f];
        if (p >= 200) continue;
        if (ids.size() <= p) ids.resize(p + 1, kNoId);
        if (ids[p] == kNoId)
          ids[p] = map.add_point(points[p], id, f).id;
        else
          map.observe(ids[p], id, f);
      }
      update_covisibility(map, id);
    }
  }

  static Pose place(int k) { return test::pose(0.02 * k, 0, 0, 0.01 * k); }

  /// Points and features agree about who sees whom.
  void expect_consistent() {
    map.points().for_each([&](const MapPoint& p) {
      EXPECT_FALSE(p.observations.empty());
      for (const Observation& o : p.observations)
        EXPECT_EQ(map.keyframe(o.keyframe)->points[o.feature], p.id);
    });
  }

  SlamMap map{ScalePyramid(8, 1.2)};
  std::vector<PointId> ids;
};

TEST_F(SlamMapTest, KeyframesThatSharePointsAreCovisible) {
  ASSERT_EQ(map.keyframe(0)->covisible.size(), 3U);
  EXPECT_GT(map.keyframe(0)->covisible.front().weight, 30);
  expect_consistent();
}

TEST_F(SlamMapTest, AFeatureSeesOnePointAndAKeyframeEachPointOnce) {
  const PointId p = map.keyframe(0)->points[0];
  ASSERT_NE(p, kNoId);
  EXPECT_FALSE(map.observe(p, 0, 1));
  EXPECT_FALSE(map.observe(p + 100000, 0, 1));
  EXPECT_FALSE(map.observe(p, 99, 0));
}

TEST_F(SlamMapTest, ErasedPointsAreForgottenByAll) {
  const PointId p = map.keyframe(1)->points[0];
  map.erase_point(p);
  EXPECT_EQ(map.point(p), nullptr);
  EXPECT_EQ(map.keyframe(1)->points[0], kNoId);
  expect_consistent();
}

TEST_F(SlamMapTest, APointThatNobodySeesIsErased) {
  const PointId p = map.keyframe(0)->points[0];
  for (KeyframeId k = 0; k < 4; ++k) map.forget(p, k);
  EXPECT_EQ(map.point(p), nullptr);
}

TEST_F(SlamMapTest, MergedPointsAreSeenByAllThatSawEither) {
  const auto& points = map.keyframe(0)->points;
  const PointId keep = points[0];
  const PointId drop = points[1];
  for (KeyframeId k = 1; k < 4; ++k) map.forget(keep, k);
  map.forget(drop, 0);
  merge_points(map, keep, drop);
  EXPECT_EQ(map.point(drop), nullptr);
  EXPECT_GE(map.point(keep)->observations.size(), 3U);
  expect_consistent();
}

TEST_F(SlamMapTest, CulledKeyframesKeepTheirPoseAndMoveWithTheirAnchor) {
  map.cull_keyframe(2);
  EXPECT_EQ(map.keyframe(2), nullptr);
  EXPECT_TRUE(map.pose_of(2).isApprox(place(2), 1e-12));
  map.cull_keyframe(1);
  map.cull_keyframe(3);  // whoever was the anchor, the chain holds
  EXPECT_TRUE(map.pose_of(2).isApprox(place(2), 1e-12));
  const Pose moved = test::pose(1, 2, 3, 0.5);
  set_pose(map, 0, moved * map.pose_of(0));
  for (int k = 0; k < 4; ++k)
    EXPECT_TRUE(map.pose_of(static_cast<KeyframeId>(k)).isApprox(moved * place(k), 1e-9)) << k;
  EXPECT_EQ(keyframe_poses(map).size(), 4U);
  EXPECT_EQ(keyframe_poses(map)[2].stamp_ns, 1002);
  expect_consistent();
}

TEST_F(SlamMapTest, TheLastKeyframeStays) {
  for (KeyframeId k = 0; k < 4; ++k) map.cull_keyframe(k);
  EXPECT_EQ(map.keyframes().size(), 1U);
}

TEST_F(SlamMapTest, CorrectionMovesKnownKeyframesOthersWithThemAndPoints) {
  map.cull_keyframe(1);
  const Pose moved = test::pose(0.5, 0, 0, 0.2);
  const PointId p = map.keyframe(0)->points[0];
  const Eigen::Vector3d before = map.point(p)->position;
  const std::vector<KeyframePose> corrected{
      {0, 0, moved * place(0)}, {1, 0, moved * place(1)}, {77, 0, moved}};
  apply_correction(map, corrected);
  for (int k = 0; k < 4; ++k)
    EXPECT_TRUE(map.pose_of(static_cast<KeyframeId>(k)).isApprox(moved * place(k), 1e-9)) << k;
  EXPECT_TRUE((map.point(p)->position - moved * before).norm() < 1e-9);
}

TEST_F(SlamMapTest, CorrectionIgnoresWhatIsNotFinite) {
  Pose broken = Pose::Identity();
  broken.translation().x() = std::numeric_limits<double>::quiet_NaN();
  apply_correction(map, std::vector<KeyframePose>{{0, 0, broken}});
  EXPECT_TRUE(map.pose_of(0).isApprox(place(0)));
}

TEST(IdTable, FindsWhatIsThereAndFreesWhatIsNot) {
  IdTable<std::shared_ptr<int>> table;
  const auto object = std::make_shared<int>(1);
  for (int i = 0; i < 1000; ++i) table.emplace(object);
  EXPECT_EQ(object.use_count(), 1001);
  for (std::uint64_t id = 0; id < 999; ++id) table.erase(id);
  table.erase(5);
  EXPECT_EQ(object.use_count(), 2);
  EXPECT_EQ(table.size(), 1U);
  EXPECT_EQ(table.find(5), nullptr);
  EXPECT_EQ(table.find(12345), nullptr);
  EXPECT_NE(table.find(999), nullptr);
  EXPECT_EQ(table.next_id(), 1000U);
}

TEST(IdTable, IdsThatAreLeftOutCostNextToNothing) {
  constexpr std::uint64_t kLeftOut = 10'000'000;  // with each restart
  constexpr std::uint64_t kRestarts = 1000;
  const auto allocated = [] {
    const auto heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
  };
  const std::size_t before = allocated();
  IdTable<int> table;
  for (std::uint64_t restart = 0; restart < kRestarts; ++restart) {
    table.skip_to(table.next_id() + kLeftOut);
    table.emplace(static_cast<int>(restart));
  }
  EXPECT_LE(allocated() - before, 20'000'000U);
  std::vector<int> seen;
  const IdTable<int> copy = table;
  copy.for_each([&](int restart) { seen.push_back(restart); }, 500 * kLeftOut);
  EXPECT_EQ(seen.size(), kRestarts - 499);
  EXPECT_TRUE(std::ranges::is_sorted(seen));
  ASSERT_NE(copy.find(kLeftOut), nullptr);
  EXPECT_EQ(*copy.find(kLeftOut), 0);
  EXPECT_EQ(table.take_touched().size(), kRestarts);
  EXPECT_TRUE(table.take_touched().empty());
  table.erase(kLeftOut);
  EXPECT_EQ(table.take_touched(), std::vector<std::size_t>{kLeftOut / IdTable<int>::kBlock});
}

}  // namespace
}  // namespace rds::tracker
