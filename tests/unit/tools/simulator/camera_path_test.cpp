// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera_path.hpp"

#include <gtest/gtest.h>

namespace rds::simulator {
namespace {

TEST(CameraPath, NamesOfThePathsAreKnown) {
  for (const char* name : {"static", "xyz", "rpy", "halfsphere", "loop"})
    EXPECT_TRUE(path_kind(name)) << name;
  EXPECT_FALSE(path_kind("spiral"));
  EXPECT_EQ(path_names(), "static|xyz|rpy|halfsphere|loop");
}

TEST(CameraPath, MovesSmoothlyAndStaysInTheFreeMiddleOfTheRoom) {
  for (const PathKind kind :
       {PathKind::kStatic, PathKind::kXyz, PathKind::kRpy, PathKind::kHalfsphere, PathKind::kLoop})
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const CameraPath path(kind, 20, seed);
      geometry::Pose previous = path.world_from_camera(0);
      for (int i = 1; i <= 600; ++i) {
        const geometry::Pose pose = path.world_from_camera(i / 30.0);
        const geometry::Pose moved = previous.inverse() * pose;
        EXPECT_LT(moved.translation().norm() * 30, 1.2);                    // m/s
        EXPECT_LT(geometry::rotation_angle_rad(moved.linear()) * 30, 1.2);  // rad/s
        EXPECT_NEAR((pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0,
                    1e-9);
        EXPECT_LT(std::abs(pose.translation().x()), 1.5);
        EXPECT_LT(std::abs(pose.translation().y()), 1.6);
        EXPECT_GT(pose.translation().z(), 0.7);
        EXPECT_LT(pose.translation().z(), 2.1);
        previous = pose;
      }
    }
}

TEST(CameraPath, LoopSeesEveryDirectionAndEndsWhereItBegan) {
  const CameraPath path(PathKind::kLoop, 20, 5);
  const geometry::Pose start = path.world_from_camera(0);
  const geometry::Pose end = path.world_from_camera(20);
  EXPECT_LT((start.translation() - end.translation()).norm(), 0.15);
  EXPECT_LT(geometry::rotation_angle_rad(start.linear().transpose() * end.linear()), 0.15);
  double least = 1;
  for (int i = 0; i < 600; ++i)
    least = std::min(least, path.world_from_camera(i / 30.0).linear().col(2).dot(start.linear().col(2)));
  EXPECT_LT(least, -0.8);
}

}  // namespace
}  // namespace rds::simulator
