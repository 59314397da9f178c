// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/alignment.hpp"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace rds::geometry {
namespace {

Pose some_pose() {
  return make_pose({3, -2, 1},
                   Eigen::Quaterniond(Eigen::AngleAxisd(0.9, Eigen::Vector3d(1, 2, -1).normalized())));
}

std::vector<Eigen::Vector3d> some_points() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 50; ++i) points.emplace_back(std::sin(i), std::cos(1.3 * i), 0.05 * i);
  return points;
}

std::vector<Eigen::Vector3d> moved(const std::vector<Eigen::Vector3d>& points, const Eigen::Affine3d& by) {
  std::vector<Eigen::Vector3d> result;
  for (const auto& p : points) result.emplace_back(by * p);
  return result;
}

TEST(AlignRigid, RecoversAKnownTransform) {
  const auto source = some_points();
  const auto found = align_rigid(source, moved(source, some_pose()));
  EXPECT_TRUE(found.target_from_source.isApprox(some_pose(), 1e-12));
  EXPECT_NEAR(found.similarity_scale, 1, 1e-12);
}

TEST(AlignRigid, ReportsScaleButNeverAppliesIt) {
  const auto source = some_points();
  const auto found = align_rigid(source, moved(source, Eigen::Affine3d(Eigen::Scaling(0.5))));
  EXPECT_NEAR(found.similarity_scale, 0.5, 1e-12);
  EXPECT_NEAR(found.target_from_source.linear().determinant(), 1, 1e-12);
}

TEST(AlignRigid, NeverMirrors) {
  const auto source = some_points();
  const auto found = align_rigid(source, moved(source, Eigen::Affine3d(Eigen::Scaling(-1.0, 1.0, 1.0))));
  EXPECT_NEAR(found.target_from_source.linear().determinant(), 1, 1e-12);
}

TEST(AlignRigid, OfOnePointIsATranslation) {
  const std::vector<Eigen::Vector3d> source{{1, 2, 3}};
  const std::vector<Eigen::Vector3d> target{{4, 4, 4}};
  EXPECT_TRUE((align_rigid(source, target).target_from_source * source[0]).isApprox(target[0]));
}

TEST(AlignRigid, RefusesUnequalCounts) {
  const auto points = some_points();
  EXPECT_THROW(align_rigid(points, {}), std::invalid_argument);
  EXPECT_THROW(align_rigid({}, {}), std::invalid_argument);
}

/// A camera that turns in its place, and is measured 4 mm off here and there.
TEST(AlignOrientations, IsSureWhereTheCameraHardlyMoves) {
  std::vector<Pose> source;
  std::vector<Pose> target;
  std::vector<Eigen::Vector3d> source_points;
  std::vector<Eigen::Vector3d> target_points;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d place = 0.01 * Eigen::Vector3d(std::sin(i), std::cos(i), std::sin(2 * i));
    const Eigen::AngleAxisd turn(0.02 * i, Eigen::Vector3d::UnitY());
    source.push_back(make_pose(place, Eigen::Quaterniond(turn)));
    target.push_back(some_pose() * source.back());
    target.back().translation() += 0.004 * Eigen::Vector3d(std::cos(0.3 * i), std::sin(0.2 * i), std::cos(i));
    source_points.emplace_back(source.back().translation());
    target_points.emplace_back(target.back().translation());
  }
  const auto off_rad = [](const Pose& found) {
    return Eigen::AngleAxisd(found.linear().transpose() * some_pose().linear()).angle();
  };
  EXPECT_LT(off_rad(align_orientations(source, target)), 1e-9);
  EXPECT_GT(off_rad(align_rigid(source_points, target_points).target_from_source), 0.01);
  EXPECT_LT((align_orientations(source, target).translation() - some_pose().translation()).norm(), 0.004);
  EXPECT_THROW(align_orientations(source, {}), std::invalid_argument);
}

}  // namespace
}  // namespace rds::geometry
