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

}  // namespace
}  // namespace rds::geometry
