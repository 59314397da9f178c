// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/new_points.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "services/tracker/core/map/covisibility.hpp"
#include "services/tracker/core/mapping/map_building.hpp"
#include "services/tracker/core/mapping/mapping_exchange.hpp"
#include "services/tracker/core/triangulation/triangulated_points.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr int kKeyframes = 6;
constexpr std::size_t kPoints = 600;
constexpr std::size_t kMeasured = 300;  // the first ones: the map has them; of the others no depth is known
constexpr double kNoisePx = 0.5;

/// Where a point is when a keyframe is made.
using World = std::function<Eigen::Vector3d(const Eigen::Vector3d& point, int keyframe)>;
using Way = std::function<Pose(int keyframe)>;

Pose aside(int k) { return test::pose(0.08 * k, 0.01 * k, 0, -0.03 * k); }
Pose turning(int k) { return test::pose(0, 0, 0, 0.05 * k); }
Eigen::Vector3d still(const Eigen::Vector3d& point, int /*keyframe*/) { return point; }

class NewPoints : public ::testing::Test {
 protected:
  /// Keyframes whose poses are known, of a camera that has depth for some points only.
  void see(int keyframes, const Way& way, const World& world = still) {
    for (int k = 0; k < keyframes; ++k) {
      std::vector<Eigen::Vector3d> now = points;
      for (std::size_t i = kMeasured; i < now.size(); ++i) now[i] = world(points[i], k);
      const auto view = test::view_of(now, way(k), kNoisePx, random);
      std::vector<Feature> features = view.features->all();
      for (std::size_t f = 0; f < features.size(); ++f)
        if (view.point[f] >= kMeasured) features[f].depth_m = 0;
      const auto set = std::make_shared<const FeatureSet>(view.features->camera(), std::move(features));
      const KeyframeId id = map.add_keyframe(k, way(k), set).id;
      for (std::uint32_t f = 0; f < view.point.size(); ++f) {
        seen.resize(id + 1);
        seen[id].push_back(view.point[f]);
        if (view.point[f] >= kMeasured) continue;
        PointId& p = known[view.point[f]];
        if (p == kNoId)
          p = map.add_point(points[view.point[f]], id, f).id;
        else
          map.observe(p, id, f);
      }
      update_covisibility(map, id);
    }
  }

  [[nodiscard]] LocalMappingResult result() const {
    LocalMappingJob job = make_mapping_job(map, map.records().next_id() - 1);
    job.pyramid = ScalePyramid(8, 1.2);
    job.triangulates = true;
    return run_local_mapping(job);
  }

  /// The points that were made, in the map.
  std::vector<const MapPoint*> made() {
    const PointId first = map.points().next_id();
    apply_mapping_result(map, result());
    std::vector<const MapPoint*> all;
    std::as_const(map).points().for_each([&](const MapPoint& p) { all.push_back(&p); }, first);
    return all;
  }

  /// One that keyframes seen from aside give.
  const MapPoint& one_made() {
    see(kKeyframes, aside);
    const auto all = made();
    if (all.empty()) throw std::logic_error("no point was made");
    return *all.front();
  }

  [[nodiscard]] const Eigen::Vector3d& truth(const MapPoint& point) const {
    const Observation& o = point.observations.front();
    return points[seen[o.keyframe][o.feature]];
  }

  std::mt19937 random{8};
  std::vector<Eigen::Vector3d> points = test::random_points(kPoints, random);
  std::vector<PointId> known = std::vector<PointId>(kPoints, kNoId);
  std::vector<std::vector<std::size_t>> seen;  // per keyframe and feature: the point
  SlamMap map{ScalePyramid(8, 1.2)};
};

/// Of 300 points without depth some 200 are in the last picture and in three before.
TEST_F(NewPoints, AreMadeOfFeaturesWithoutDepthAsExactAsASensorsWouldBe) {
  see(kKeyframes, aside);
  const auto all = made();
  EXPECT_GE(all.size(), 120U);
  const Keyframe& centre = *std::as_const(map).keyframe(kKeyframes - 1);
  const ObservationModel model(centre.features->camera());
  double squares = 0;
  for (const MapPoint* p : all) {
    EXPECT_GE(p->observations.size(), kMinTriangulatingViews);
    EXPECT_TRUE(rests_on_views(map, *p));
    const auto disparity = [&](const Eigen::Vector3d& point) {
      return model.disparity((centre.map_from_camera.inverse() * point).z());
    };
    squares += std::pow(disparity(p->position) - disparity(truth(*p)), 2);
    for (const Observation& o : p->observations)
      EXPECT_EQ(seen[o.keyframe][o.feature], seen[p->observations[0].keyframe][p->observations[0].feature]);
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(all.size())), kDisparitySigmaPx);
}

TEST_F(NewPoints, NoneWhereNobodyAsks) {
  see(kKeyframes, aside);
  LocalMappingJob job = make_mapping_job(map, kKeyframes - 1);
  job.pyramid = ScalePyramid(8, 1.2);
  EXPECT_TRUE(run_local_mapping(job).made.empty());
}

TEST_F(NewPoints, NoneOfTwoKeyframes) {
  see(2, [](int k) { return aside(4 * k); });
  EXPECT_TRUE(result().made.empty());
}

TEST_F(NewPoints, NoneWhereTheCameraOnlyTurns) {
  see(kKeyframes, turning);
  EXPECT_TRUE(result().made.empty());
}

/// One who walks and sways. (What moves at a constant speed while the camera does cannot be told from what
/// stands still elsewhere.)
TEST_F(NewPoints, NoneOfWhatMoves) {
  constexpr std::array kSwayM{0.0, 0.12, -0.1, 0.06, -0.05, 0.2};
  see(kKeyframes, aside, [&](const Eigen::Vector3d& p, int k) -> Eigen::Vector3d {
    return p + Eigen::Vector3d(-0.06 * k, kSwayM[static_cast<std::size_t>(k)], 0.03 * k);
  });
  EXPECT_LE(made().size(), 2U);
}

TEST_F(NewPoints, NoneOfMovableFeatures) {
  see(kKeyframes, aside);
  for (KeyframeId k = 0; k < kKeyframes; ++k)
    for (std::size_t f = 0; f < seen[k].size(); ++f)
      map.keyframe(k)->movable[f] = seen[k][f] >= kMeasured;
  EXPECT_TRUE(result().made.empty());
}

TEST_F(NewPoints, NoneOfFeaturesThatWereTakenOrMovedMeanwhile) {
  see(kKeyframes, aside);
  const LocalMappingResult before = result();
  ASSERT_GE(before.made.size(), 2U);
  const auto& taken = before.made[0].seen.front();
  const auto& moved = before.made[1].seen.back();
  map.add_point({0, 0, 2}, taken.keyframe, taken.feature);
  map.keyframe(moved.keyframe)->movable[moved.feature] = true;
  const std::size_t points_before = map.points().size();
  apply_mapping_result(map, before);
  EXPECT_EQ(map.points().size(), points_before + before.made.size() - 2);
}

TEST_F(NewPoints, APointGoesWithTheViewsThatItRestsOn) {
  const PointId id = one_made().id;
  while (map.point(id) != nullptr && map.point(id)->observations.size() >= kMinTriangulatingViews) {
    map.forget(id, map.point(id)->observations.front().keyframe);
    erase_if_unknown(map, id);
  }
  EXPECT_EQ(map.point(id), nullptr);
}

TEST_F(NewPoints, APointThatIsSeenWithDepthIsAnOrdinaryOne) {
  const MapPoint& made_point = one_made();
  const PointId id = made_point.id;
  const Observation first = made_point.observations.front();
  const auto with_depth = test::view_of(points, aside(kKeyframes), 0, random);
  const KeyframeId next = map.add_keyframe(9, aside(kKeyframes), with_depth.features).id;
  const auto shown = std::ranges::find(with_depth.point, seen[first.keyframe][first.feature]);
  ASSERT_NE(shown, with_depth.point.end());
  map.observe(id, next, static_cast<std::uint32_t>(shown - with_depth.point.begin()));
  EXPECT_FALSE(rests_on_views(map, *map.point(id)));
  while (map.point(id)->observations.size() > 1) map.forget(id, map.point(id)->observations.front().keyframe);
  erase_if_unknown(map, id);
  EXPECT_NE(map.point(id), nullptr);
}

/// Late boxes say that one of the views was of something movable: then the others mean nothing.
TEST_F(NewPoints, LateBoxesTakeAPointBackWholly) {
  const MapPoint& made_point = one_made();
  const PointId id = made_point.id;
  const Observation first = made_point.observations.front();
  const Eigen::Vector2f px = (*map.keyframe(first.keyframe)->features)[first.feature].image_px;
  const cv::Rect around(static_cast<int>(px.x()) - 2, static_cast<int>(px.y()) - 2, 5, 5);
  retract_movable(map, first.keyframe, test::mask_of(around & cv::Rect(0, 0, 320, 240)), DepthConfig{});
  EXPECT_EQ(map.point(id), nullptr);
}

TEST_F(NewPoints, AreTheSameTwice) {
  see(kKeyframes, aside);
  const auto a = result();
  const auto b = result();
  ASSERT_EQ(a.made.size(), b.made.size());
  for (std::size_t i = 0; i < a.made.size(); ++i) EXPECT_EQ(a.made[i].position, b.made[i].position);
}

}  // namespace
}  // namespace rds::tracker
