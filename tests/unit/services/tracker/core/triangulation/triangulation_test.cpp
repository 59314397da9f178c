// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/triangulation/triangulation.hpp"

#include <random>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

/// What a camera measures of a point, with one pixel of noise.
PointView view_of(const Eigen::Vector3d& point, const geometry::Pose& map_from_camera, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 1);
  PointView view{map_from_camera.inverse(), ObservationModel(test::small_camera()), {}};
  view.measurement.px =
      view.model.project(view.camera_from_map * point) + Eigen::Vector2d(noise(random), noise(random));
  return view;
}

/// Views from an arc of so many metres, turned towards what is before its middle.
std::vector<PointView> views_of(const Eigen::Vector3d& point, double arc_m, std::mt19937& random) {
  std::vector<PointView> views;
  for (const double at : {-0.5, -0.2, 0.1, 0.5})
    views.push_back(view_of(point, test::pose(at * arc_m, 0.1 * at * arc_m, 0, -0.3 * at * arc_m), random));
  return views;
}

/// The normalised squared error of 1000 points is χ² with 3000 degrees of freedom: 3 ± 0.15 on average
/// (95 %), and up to a tenth more because distances are not linear in pixels.
TEST(Triangulation, ErrorsAreAsLargeAsTheCovarianceSays) {
  std::mt19937 random(1);
  double sum = 0;
  int count = 0;
  for (const Eigen::Vector3d& point : test::random_points(1000, random)) {
    const auto found = triangulate(views_of(point, 0.5, random));
    ASSERT_TRUE(found);
    const Eigen::Vector3d error = found->position - point;
    sum += error.dot(found->covariance.inverse() * error);
    ++count;
  }
  EXPECT_NEAR(sum / count, 3, 0.3);
}

TEST(Triangulation, WithoutNoiseItIsExact) {
  std::mt19937 random(2);
  for (const Eigen::Vector3d& point : test::random_points(20, random)) {
    auto views = views_of(point, 0.2, random);
    for (PointView& view : views) view.measurement.px = view.model.project(view.camera_from_map * point);
    const auto found = triangulate(views);
    ASSERT_TRUE(found);
    EXPECT_LT((found->position - point).norm(), 1e-6);
    for (const PointView& view : views) EXPECT_TRUE(agrees(view, found->position));
  }
}

TEST(Triangulation, ACameraThatOnlyTurnsTellsNoDistance) {
  std::mt19937 random(3);
  for (const Eigen::Vector3d& point : test::random_points(200, random)) {
    std::vector<PointView> views;
    for (const double turn : {-0.2, -0.1, 0.0, 0.1})
      views.push_back(view_of(point, test::pose(0, 0, 0, turn), random));
    const auto found = triangulate(views);
    EXPECT_FALSE(found && is_known_well(*found, views.back()));
  }
}

/// b σ_px √2 / B ≤ 0.6 px, whatever the distance: two views must be 0.183 m apart, for a corner of level 0.
TEST(Triangulation, TheBaselineDecidesWhetherAPointIsKnownWell) {
  std::mt19937 random(4);
  for (const double z : {1.0, 3.0, 9.0})
    for (const double baseline_m : {0.15, 0.22}) {
      const Eigen::Vector3d point(0, 0, z);
      std::vector<PointView> views;
      for (const double x : {-baseline_m / 2, baseline_m / 2})
        views.push_back(view_of(point, test::pose(x, 0, 0), random));
      const TriangulatedPoint exact{point, covariance_at(views, point)};
      EXPECT_EQ(is_known_well(exact, views.back()), baseline_m > 0.183) << z;
    }
}

TEST(Triangulation, MeasuredDepthCounts) {
  std::mt19937 random(5);
  const Eigen::Vector3d point(0.1, 0, 2);
  auto views = views_of(point, 0.02, random);
  EXPECT_FALSE(is_known_well({point, covariance_at(views, point)}, views.back()));
  Measurement& measured = views.front().measurement;
  measured.disparity_px = views.front().model.disparity((views.front().camera_from_map * point).z());
  measured.disparity_weight = 1 / kDisparitySigmaPx;
  EXPECT_TRUE(is_known_well({point, covariance_at(views, point)}, views.back()));
}

TEST(Triangulation, NothingBehindACamera) {
  std::mt19937 random(6);
  std::vector<PointView> views{view_of({-0.8, 0, 2}, test::pose(-0.2, 0, 0), random),
                               view_of({0.8, 0, 2}, test::pose(0.2, 0, 0), random)};  // the rays part
  EXPECT_FALSE(triangulate(views));
}

}  // namespace
}  // namespace rds::tracker
