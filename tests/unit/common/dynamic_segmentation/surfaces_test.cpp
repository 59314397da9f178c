// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/surfaces.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/unit/common/dynamic_segmentation/small_grid.hpp"

namespace rds::segmentation {
namespace {

using test::small_grid;

TEST(Surfaces, StepsGrowWithDepthSquared) {
  EXPECT_TRUE(one_surface(0.5F, 0.54F, 0.05));
  EXPECT_FALSE(one_surface(0.5F, 0.56F, 0.05));
  EXPECT_TRUE(one_surface(3, 3.4F, 0.05));
  EXPECT_FALSE(one_surface(3.5F, 3, 0.05)) << "by the nearer one's depth";
}

TEST(Surfaces, APlanesNormalIsItsOwn) {
  const Eigen::Vector3f normal = Eigen::Vector3f(0.3F, -0.8F, -0.5F).normalized();
  cv::Mat1f depth_m(small_grid().size());
  for (int r = 0; r < depth_m.rows; ++r)
    for (int c = 0; c < depth_m.cols; ++c) depth_m(r, c) = -1.2F / normal.dot(small_grid().ray(c, r));
  const SurfaceCells plane{depth_m, small_grid()};
  const int column = depth_m.cols / 2;
  const int row = depth_m.rows - 10;
  EXPECT_NEAR(std::abs(plane.normal(column, row).normalized().dot(normal)), 1, 1e-3);
  EXPECT_NEAR(plane.point(column, row).dot(normal), -1.2, 1e-4);
}

TEST(Surfaces, NoNormalAtAStepAHoleOrTheRim) {
  cv::Mat1f depth_m(small_grid().size(), 2.0F);
  depth_m.colRange(0, 20).setTo(1);
  depth_m(30, 40) = 0;
  const SurfaceCells cells{depth_m, small_grid()};
  EXPECT_TRUE(cells.normal(19, 10).isZero());
  EXPECT_TRUE(cells.normal(41, 30).isZero());
  EXPECT_TRUE(cells.normal(0, 10).isZero());
  EXPECT_FALSE(cells.normal(30, 10).isZero());
}

}  // namespace
}  // namespace rds::segmentation
