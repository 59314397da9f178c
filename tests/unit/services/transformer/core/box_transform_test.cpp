// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/core/box_transform.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace rds::transformer {
namespace {

using geometry::Pose;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

geometry::CameraModel pinhole() {
  geometry::CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 500;
  camera.cx = 320;
  camera.cy = 240;
  return camera;
}

Pose tilted() {
  return geometry::make_pose(
      {1, -2, 0.5}, Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized())));
}

TEST(BoxTransform, PutsTheTwoCornerPointsIntoTheMiddlePlaneOfTheBox) {
  const auto box = box_in_map({220, 140, 420, 440}, 2.0, "person", tilted(), pinhole());
  ASSERT_TRUE(box);
  const Eigen::Vector3d p_w1 = tilted() * Eigen::Vector3d(-0.4, -0.4, 2);
  const Eigen::Vector3d p_w2 = tilted() * Eigen::Vector3d(0.4, 0.8, 2);
  const Eigen::Vector3d half(box->size.x() / 2, box->size.y() / 2, 0);
  EXPECT_LT((box->map_from_box * -half - p_w1).norm(), 1e-9);
  EXPECT_LT((box->map_from_box * half - p_w2).norm(), 1e-9);
  EXPECT_LT((box->map_from_box.linear() - tilted().linear()).norm(), 1e-9);
}

TEST(BoxTransform, GivesTheThicknessOfTheLabelOrTheDefault) {
  TransformerConfig config;
  config.labels = labels::Table({{"dog", {.thickness_m = 0.33}}}, {.thickness_m = 0.44});
  EXPECT_EQ(box_in_map({0, 0, 9, 9}, 1, "dog", tilted(), pinhole(), config)->size.z(), 0.33);
  EXPECT_EQ(box_in_map({0, 0, 9, 9}, 1, "cat", tilted(), pinhole(), config)->size.z(), 0.44);
}

TEST(BoxTransform, HullContainsAllCorners) {
  const auto box = box_in_map({220, 140, 420, 440}, 2.0, "person", tilted(), pinhole());
  ASSERT_TRUE(box);
  geometry::Box3 hull = box->axis_aligned_hull();
  hull.min.array() -= 1e-9;
  hull.max.array() += 1e-9;
  for (const Eigen::Vector3d& corner : box->corners()) EXPECT_TRUE(hull.contains(corner));
  EXPECT_TRUE(box->contains(tilted() * Eigen::Vector3d(0, 0.2, 2.2)));
  EXPECT_FALSE(box->contains(tilted() * Eigen::Vector3d(0, 0.2, 2.4)));
}

TEST(BoxTransform, CutsOffWhatIsOutsideThePicture) {
  const auto box = box_in_map({-100, -50, 320, 600}, 1.0, "person", Pose::Identity(), pinhole());
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->size.x(), 320 / 500., 1e-12);
  EXPECT_NEAR(box->size.y(), 480 / 500., 1e-12);
}

TEST(BoxTransform, RejectsWhatIsNotABoxInThePicture) {
  const auto rejects = [](const geometry::Box2& box) {
    return !box_in_map(box, 2, "person", tilted(), pinhole()).has_value();
  };
  EXPECT_TRUE(rejects({kNan, 0, 10, 10}));
  EXPECT_TRUE(rejects({0, 0, kInfinity, 10}));
  EXPECT_TRUE(rejects({10, 10, 5, 20}));
  EXPECT_TRUE(rejects({10, 10, 10, 20}));
  EXPECT_TRUE(rejects({700, 10, 800, 20}));
  EXPECT_TRUE(rejects({10, -30, 20, -10}));
}

TEST(BoxTransform, RejectsDepthsThatAreNoMeasurement) {
  for (const double depth : {0., -1., 0.19, 10.1, kNan, kInfinity})
    EXPECT_FALSE(box_in_map({10, 10, 50, 50}, depth, "person", tilted(), pinhole())) << depth;
}

TEST(BoxTransform, RejectsABrokenPoseOrCamera) {
  Pose broken = Pose::Identity();
  broken.translation().z() = kNan;
  EXPECT_FALSE(box_in_map({10, 10, 50, 50}, 2, "person", broken, pinhole()));
  EXPECT_FALSE(box_in_map({10, 10, 50, 50}, 2, "person", tilted(), geometry::CameraModel()));
}

}  // namespace
}  // namespace rds::transformer
