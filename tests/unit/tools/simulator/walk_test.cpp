// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/people/walk.hpp"

#include <gtest/gtest.h>

namespace rds::simulator {
namespace {

/// An empty room of 6 × 5 m with a table in it.
Scene room_with_table() {
  Scene scene;
  const geometry::Box3 box{{-3, -2.5, 0}, {3, 2.5, 2.6}};
  scene.rooms = {{box, {}, {}, {}}};
  scene.objects = {{.label = "", .box = box},
                   {.label = "diningtable", .box = {{-0.5, 0.6, 0}, {0.5, 1.4, 0.75}}}};
  return scene;
}

const geometry::CameraModel kCamera{640, 480, 525, 525, 319.5, 239.5, {}};

geometry::Pose camera_at_south(double) {
  geometry::Pose pose = geometry::Pose::Identity();
  pose.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  pose.translation() = Eigen::Vector3d(0, -1.2, 1.4);
  return pose;
}

TEST(FloorMap, FindsAWayAroundTheTable) {
  const FloorMap floor(room_with_table());
  EXPECT_FALSE(floor.is_free({0, 1}));
  EXPECT_TRUE(floor.is_free({0, 0}));
  EXPECT_TRUE(floor.is_free(floor.nearest_free({0, 1})));
  const auto path = floor.path({0, 0.2}, {0, 1.9});
  ASSERT_GT(path.size(), 20U);
  for (const auto& p : path) EXPECT_TRUE(floor.is_free(p));
  EXPECT_LT((path.back() - Eigen::Vector2d(0, 1.9)).norm(), 0.06);
}

TEST(WalkPlanner, PeopleKeepClearOfFurnitureCameraAndEachOther) {
  const FloorMap floor(room_with_table());
  WalkPlanner planner(floor, kCamera, camera_at_south, 12);
  const Walk a = planner.plan(1.0, Random(3, 1));
  const Walk b = planner.plan(0.8, Random(3, 2));
  double travelled = 0;
  int too_near = 0;
  int frames = 0;
  for (double t = 0; t < 12; t += 0.05, ++frames) {
    EXPECT_TRUE(floor.is_free(a.at(t).position));
    EXPECT_GT((a.at(t).position - Eigen::Vector2d(0, -1.2)).norm(), 0.7);
    too_near += (a.at(t).position - b.at(t).position).norm() < 0.4 ? 1 : 0;
    EXPECT_LT(a.velocity(t).norm(), 1.4);
    travelled += (a.at(t + 0.05).position - a.at(t).position).norm();
  }
  EXPECT_LT(too_near, frames / 20);
  EXPECT_GT(travelled, 2.0);
}

TEST(WalkPlanner, TheFirstPersonDoesNotDependOnTheSecond) {
  const FloorMap floor(room_with_table());
  WalkPlanner one(floor, kCamera, camera_at_south, 5);
  WalkPlanner two(floor, kCamera, camera_at_south, 5);
  const Walk alone = one.plan(1.0, Random(4, 1));
  const Walk first = two.plan(1.0, Random(4, 1));
  two.plan(1.0, Random(4, 2));
  for (double t = 0; t < 5; t += 0.1) EXPECT_EQ(alone.at(t).position, first.at(t).position);
}

}  // namespace
}  // namespace rds::simulator
