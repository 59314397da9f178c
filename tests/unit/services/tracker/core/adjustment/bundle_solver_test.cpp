// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/adjustment/bundle_solver.hpp"

#include <random>

#include <gtest/gtest.h>

#include "services/tracker/core/motion/se3.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

using geometry::Pose;

Pose camera_from_map(std::size_t camera) {
  return test::pose(0.1 * static_cast<double>(camera), 0, 0, 0.02 * static_cast<double>(camera)).inverse();
}

/// Six cameras before 80 points that all see, the first one fixed; then all but it are moved.
Bundle disturbed() {
  Bundle bundle;
  const ObservationModel model(test::small_camera());
  for (std::size_t c = 0; c < 6; ++c) bundle.cameras.push_back({camera_from_map(c), model, c == 0});
  std::mt19937 random{4};
  for (const Eigen::Vector3d& position : test::random_points(80, random)) {
    BundlePoint& point = bundle.points.emplace_back(BundlePoint{position, {}});
    for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
      const Eigen::Vector3d p = bundle.cameras[c].camera_from_map * position;
      point.observations.push_back({c, {model.project(p), model.disparity(p.z()), 1, 1 / kDisparitySigmaPx}});
    }
    point.position += Eigen::Vector3d(0.02, -0.01, 0.02);
  }
  for (std::size_t c = 1; c < bundle.cameras.size(); ++c)
    bundle.cameras[c].camera_from_map =
        test::pose(0.03, -0.02, 0.01, 0.01) * bundle.cameras[c].camera_from_map;
  return bundle;
}

double error(const Bundle& bundle) {
  double largest = 0;
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c)
    largest = std::max(
        largest, se3_log(bundle.cameras[c].camera_from_map * camera_from_map(c).inverse()).norm());
  return largest;
}

TEST(BundleSolver, BringsCamerasAndPointsBack) {
  Bundle bundle = disturbed();
  ASSERT_GT(error(bundle), 0.03);
  solve_bundle(bundle, {});
  EXPECT_LT(error(bundle), 1e-4);
}

TEST(BundleSolver, AWrongObservationHardlyCountsWhereItIsRobust) {
  Bundle bundle = disturbed();
  for (std::size_t p = 0; p < 8; ++p) bundle.points[p].observations[3].measurement.px.x() += 60;
  Bundle plain = bundle;
  solve_bundle(bundle, {});
  solve_bundle(plain, {.is_robust = false, .stop = {}});
  EXPECT_LT(error(bundle), 0.01);
  EXPECT_LT(error(bundle), 0.3 * error(plain));
}

TEST(BundleSolver, GivesTheSameBitsTwice) {
  Bundle one = disturbed();
  Bundle other = disturbed();
  solve_bundle(one, {});
  solve_bundle(other, {});
  for (std::size_t c = 0; c < one.cameras.size(); ++c)
    EXPECT_EQ(one.cameras[c].camera_from_map.matrix(), other.cameras[c].camera_from_map.matrix());
}

TEST(BundleSolver, DoesNothingWhenItIsStopped) {
  Bundle bundle = disturbed();
  const double before = error(bundle);
  std::stop_source stop;
  stop.request_stop();
  solve_bundle(bundle, {.stop = stop.get_token()});
  EXPECT_EQ(error(bundle), before);
}

}  // namespace
}  // namespace rds::tracker
