// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/oriented_box.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace rds::geometry {
namespace {

OrientedBox turned_box() {
  OrientedBox box;
  box.map_from_box = make_pose(
      {1, -2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized())));
  box.size = {0.5, 1.8, 0.6};
  return box;
}

TEST(OrientedBox, HullIsTheSmallestThatHoldsAllCorners) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const Eigen::Vector3d& corner : turned_box().corners()) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const Box3 hull = turned_box().axis_aligned_hull();
  EXPECT_LT((hull.min - low).norm(), 1e-12);
  EXPECT_LT((hull.max - high).norm(), 1e-12);
}

TEST(OrientedBox, ContainsWhatLiesWithinItsOwnAxes) {
  const OrientedBox box = turned_box();
  EXPECT_TRUE(box.contains(box.map_from_box * Eigen::Vector3d(0.24, 0.89, -0.29)));
  EXPECT_FALSE(box.contains(box.map_from_box * Eigen::Vector3d(0.26, 0, 0)));
  EXPECT_FALSE(box.contains(box.map_from_box * Eigen::Vector3d(0, 0, 0.31)));
}

TEST(OrientedBox, IsInvalidWithoutVolumeOrWithNumbersThatAreNone) {
  EXPECT_TRUE(is_valid(turned_box()));
  OrientedBox flat = turned_box();
  flat.size.z() = 0;
  EXPECT_FALSE(is_valid(flat));
  OrientedBox nowhere = turned_box();
  nowhere.map_from_box.translation().y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_valid(nowhere));
}

}  // namespace
}  // namespace rds::geometry
