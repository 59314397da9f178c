// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/bundle/sparse_bundle.hpp"

#include <random>

#include <gtest/gtest.h>

#include "services/tracker/core/bundle/reduced_system.hpp"

namespace rds::tracker {
namespace {

constexpr int kCameras = 30;
constexpr double kStepM = 0.2;  // between cameras; each sees some 2 m of a long wall

geometry::CameraModel camera() {
  return {640, 480, 525, 525, 319.5, 239.5, {}};
}

geometry::Pose true_pose(int camera) {
  return geometry::make_pose({-kStepM * camera, 0, 0}, Eigen::Quaterniond::Identity());
}

/// Points before a wall that cameras see exactly as they are.
SparseBundle exact_bundle() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along(-1, kStepM * kCameras + 1);
  std::uniform_real_distribution<double> up(-1, 1);
  std::uniform_real_distribution<double> depth(1.5, 3.5);
  SparseBundle bundle;
  const ObservationModel model(camera());
  for (int c = 0; c < kCameras; ++c) bundle.cameras.push_back({true_pose(c), model, c == 0});
  for (int i = 0; i < 600; ++i) {
    const Eigen::Vector3d point(along(random), up(random), depth(random));
    std::vector<SparseBundle::Observation> seen;
    for (int c = 0; c < kCameras; ++c) {
      const Eigen::Vector3d p = true_pose(c) * point;
      const Eigen::Vector2d px = model.project(p);
      if (px.x() < 0 || px.y() < 0 || px.x() > 639 || px.y() > 479) continue;
      const bool has_depth = i % 3 != 0;
      seen.push_back({static_cast<std::uint32_t>(c),
                      {px, has_depth ? model.disparity(p.z()) : 0, 1, has_depth ? 1 / kDisparitySigmaPx : 0}});
    }
    if (seen.size() < 2) continue;
    bundle.points.push_back(point);
    bundle.seen.push_back(std::move(seen));
  }
  return bundle;
}

/// Cameras and points elsewhere than where they are seen.
SparseBundle disturbed(SparseBundle bundle) {
  for (std::size_t c = 1; c < bundle.cameras.size(); ++c) {
    const double drift = 0.003 * static_cast<double>(c);
    Twist twist;
    twist << drift, -drift, drift / 2, 0, 0.1 * drift, -0.1 * drift;
    bundle.cameras[c].camera_from_map = se3_exp(twist) * bundle.cameras[c].camera_from_map;
  }
  for (std::size_t p = 0; p < bundle.points.size(); ++p)
    bundle.points[p] += 0.02 * Eigen::Vector3d(p % 3 == 0 ? 1 : -1, p % 2 == 0 ? 1 : -1, 1);
  return bundle;
}

/// Largest distance of a camera from where it is in truth [m, rad].
double error_of(const SparseBundle& bundle) {
  double largest = 0;
  for (int c = 0; c < kCameras; ++c)
    largest = std::max(largest, se3_log(bundle.cameras[static_cast<std::size_t>(c)].camera_from_map *
                                        true_pose(c).inverse())
                                    .norm());
  return largest;
}

TEST(SparseBundle, FindsCamerasAndPoints) {
  const SparseBundle exact = exact_bundle();
  SparseBundle bundle = disturbed(exact);
  ASSERT_GT(error_of(bundle), 0.1);
  ASSERT_TRUE(adjust(bundle, {}));
  EXPECT_LT(error_of(bundle), 1e-4);
  for (std::size_t p = 0; p < bundle.points.size(); ++p)
    EXPECT_LT((bundle.points[p] - exact.points[p]).norm(), 1e-3) << p;
}

TEST(SparseBundle, AFewWrongMatchesHardlyMoveIt) {
  SparseBundle bundle = exact_bundle();
  for (std::size_t p = 0; p < bundle.points.size(); p += 10)
    bundle.seen[p].front().measurement.px += Eigen::Vector2d(25, -30);
  SparseBundle by_squares = bundle;
  ASSERT_TRUE(adjust(bundle, {}));
  ASSERT_TRUE(adjust(by_squares, {.is_robust = false, .stop = {}}));
  EXPECT_LT(error_of(bundle), 0.03);
  EXPECT_GT(error_of(by_squares), 2 * error_of(bundle));
}

TEST(SparseBundle, CamerasThatAreFixedOrSeeNothingStay) {
  SparseBundle bundle = disturbed(exact_bundle());
  bundle.cameras[9].is_fixed = true;
  bundle.cameras.push_back({true_pose(3), ObservationModel(camera()), false});
  const SparseBundle before = bundle;
  ASSERT_TRUE(adjust(bundle, {}));
  for (const std::size_t c : {std::size_t{0}, std::size_t{9}, std::size_t{kCameras}})
    EXPECT_EQ(bundle.cameras[c].camera_from_map.matrix(), before.cameras[c].camera_from_map.matrix()) << c;
  EXPECT_LT(cost_of(bundle, true), cost_of(before, true));
}

TEST(SparseBundle, AStepIsWhatTheLinearModelExpects) {
  SparseBundle bundle = exact_bundle();
  bundle.cameras[5].camera_from_map.translation().x() += 1e-4;
  ReducedSystem system(bundle);
  const auto step = system.solve(bundle, true, 1e-8);
  ASSERT_TRUE(step);
  EXPECT_NEAR(step->expected_gain, cost_of(bundle, true), 0.01 * cost_of(bundle, true));
  EXPECT_NEAR(step->cameras[5].x(), -1e-4, 1e-6);
}

TEST(SparseBundle, NothingIsAdjustedToNothing) {
  SparseBundle bundle;
  EXPECT_TRUE(adjust(bundle, {}));
}

}  // namespace
}  // namespace rds::tracker
