// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/box.hpp"

#include <gtest/gtest.h>

namespace rds::geometry {
namespace {

const CameraModel kCamera{640, 480, 500, 500, 320, 240, {}};

TEST(Iou, IsOneForEqualBoxesAndZeroForDisjointOnes) {
  EXPECT_DOUBLE_EQ(iou({0, 0, 10, 10}, {0, 0, 10, 10}), 1.0);
  EXPECT_DOUBLE_EQ(iou({0, 0, 10, 10}, {10, 0, 20, 10}), 0.0);
  EXPECT_NEAR(iou({0, 0, 10, 10}, {5, 0, 15, 10}), 50.0 / 150.0, 1e-12);
}

TEST(ProjectBox, BoundsTheNearFace) {
  const Box3 box{{-0.5, -0.5, 2.0}, {0.5, 0.5, 3.0}};
  const auto image_box = project(box, Pose::Identity(), kCamera);
  ASSERT_TRUE(image_box);
  EXPECT_EQ(*image_box, (Box2{195, 115, 445, 365}));
}

TEST(ProjectBox, IsNothingBehindTheCameraAndBesideTheImage) {
  EXPECT_FALSE(project({{-1, -1, -3}, {1, 1, -2}}, Pose::Identity(), kCamera));
  EXPECT_FALSE(project({{9, -1, 2}, {10, 1, 3}}, Pose::Identity(), kCamera));
}

TEST(ProjectBox, ReachesTheImageBorderWhenItSurroundsTheCamera) {
  const auto image_box = project({{-1, -1, -1}, {1, 1, 1}}, Pose::Identity(), kCamera);
  ASSERT_TRUE(image_box);
  EXPECT_EQ(*image_box, (Box2{0, 0, 640, 480}));
}

}  // namespace
}  // namespace rds::geometry
