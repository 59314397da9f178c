// SPDX-License-Identifier: Apache-2.0
// A floor as a plan: rooms, doors, furniture as footprints, and the robot's way through it. No textures.
#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "tools/simulator/building/floor_layout.hpp"
#include "tools/simulator/building/furnishing.hpp"
#include "tools/simulator/people/walk.hpp"
#include "tools/simulator/robot_path.hpp"

namespace rds::simulator {
namespace {

constexpr std::array<int, 4> kRoomCounts{8, 9, 12, 30};

bool overlap(const geometry::Box3& a, const geometry::Box3& b) {
  return (a.min.array() + 1e-6 < b.max.array()).all() && (b.min.array() + 1e-6 < a.max.array()).all();
}

/// Rooms without walls that show, and openings.
Scene empty_floor(const FloorLayout& layout) {
  Scene scene;
  for (const RoomPlan& room : layout.rooms) scene.rooms.push_back({room.box, {}, {}, {}});
  scene.openings = layout.openings;
  scene.objects = {{.label = "", .box = scene.bounds()}};
  return scene;
}

TEST(FloorLayout, HasAsManyRoomsAsAskedForAndNoneOverlap) {
  for (const int count : kRoomCounts) {
    const FloorLayout layout = lay_out_floor(7, count);
    const auto is_room = [](const RoomPlan& room) { return room.kind != RoomKind::kCorridor; };
    EXPECT_EQ(std::ranges::count_if(layout.rooms, is_room), count);
    for (std::size_t i = 0; i < layout.rooms.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        EXPECT_FALSE(overlap(layout.rooms[i].box, layout.rooms[k].box)) << i << ' ' << k;
  }
}

TEST(FloorLayout, EveryOpeningReachesFromFaceToFaceOfItsRooms) {
  for (const int count : kRoomCounts) {
    const FloorLayout layout = lay_out_floor(3, count);
    for (const Opening& opening : layout.openings) {
      EXPECT_GT(opening.box.size().head<2>().maxCoeff(), 0.85);
      for (const std::size_t index : opening.rooms) {
        const geometry::Box3& room = layout.rooms[index].box;
        EXPECT_FALSE(overlap(opening.box, room));
        const Eigen::Vector3d gap = (opening.box.min - room.max).cwiseMax(room.min - opening.box.max);
        EXPECT_NEAR(gap.maxCoeff(), 0, 1e-9);
      }
    }
  }
}

TEST(FloorLayout, SomeRoomsLookAlikeAndHaveTheSameSize) {
  std::map<std::uint64_t, std::vector<RoomPlan>> of_style;
  for (const RoomPlan& room : lay_out_floor(5, 12).rooms) of_style[room.style].push_back(room);
  int pairs = 0;
  for (const auto& [style, rooms] : of_style) {
    if (rooms.size() < 2) continue;
    ++pairs;
    EXPECT_NEAR((rooms[0].box.size() - rooms[1].box.size()).norm(), 0, 1e-9);
    EXPECT_EQ(rooms[0].kind, rooms[1].kind);
  }
  EXPECT_EQ(pairs, 4);
}

TEST(FloorMap, LeadsFromTheCorridorIntoEveryRoomOfAFloor) {
  for (const int count : kRoomCounts) {
    const Scene scene = empty_floor(lay_out_floor(11, count));
    FloorMap floor(scene, RobotPath::kClearanceM);
    floor.keep_connected_to(scene.rooms.front().box.center().head<2>());
    for (const Room& room : scene.rooms) EXPECT_TRUE(floor.is_free(room.box.center().head<2>()));
  }
}

RoomPlan office() {
  return {.box = {{0, 0, 0}, {5, 4.8, 2.65}},
          .kind = RoomKind::kOffice,
          .style = 9,
          .is_turned = false,
          .has_window = true};
}

const std::vector<DoorZone> kDoor{{{1.0, -2.4}, {0, 1}}};

TEST(Furnish, PiecesStandInTheRoomApartFromEachOtherAndFromTheWayIn) {
  const auto standing = furnish(office(), kDoor, 0, 1);
  ASSERT_GE(standing.size(), 4U);
  const Eigen::AlignedBox2d room(Eigen::Vector2d(-2.501, -2.401), Eigen::Vector2d(2.501, 2.401));
  const Eigen::AlignedBox2d way(Eigen::Vector2d(0.5, -2.4), Eigen::Vector2d(1.5, 0));
  for (std::size_t i = 0; i < standing.size(); ++i) {
    EXPECT_TRUE(room.contains(standing[i].footprint));
    EXPECT_FALSE(way.intersects(standing[i].footprint));
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(standing[i].footprint.intersects(standing[k].footprint));
  }
}

TEST(Furnish, OnALaterDaySomePiecesStandElsewhereAndTheOthersWhereTheyWere) {
  int moved = 0;
  int stayed = 0;
  for (std::uint64_t own = 0; own < 10; ++own) {
    const auto first = furnish(office(), kDoor, 0, own);
    const auto second = furnish(office(), kDoor, 1, own);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].piece, second[i].piece);
      EXPECT_EQ(first[i].look, second[i].look);
      (first[i].footprint.isApprox(second[i].footprint) ? stayed : moved) += 1;
    }
  }
  EXPECT_GT(moved, 0);
  EXPECT_GT(stayed, moved);
}

TEST(RobotPath, KeepsItsHeightItsSpeedAndItsTurnRate) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const RobotPath path(empty_floor(lay_out_floor(seed, 8)), 60, seed);
    constexpr double kStep = 1.0 / 30;
    double travelled = 0;
    double turned = 0;
    for (double t = 0; t < 60; t += kStep) {
      const geometry::Pose pose = path.world_from_camera(t);
      const geometry::Pose moved = pose.inverse() * path.world_from_camera(t + kStep);
      const double angle = geometry::rotation_angle_rad(moved.linear());
      EXPECT_LT(moved.translation().norm(), RobotPath::kFastestM_s * kStep);
      EXPECT_LT(angle, RobotPath::kTurnRateRad_s * kStep);
      EXPECT_NEAR(pose.translation().z(), RobotPath::kCameraHeightM, 1e-9);
      travelled += moved.translation().norm();
      turned += angle;
    }
    EXPECT_GT(travelled, 12);
    EXPECT_GT(turned, 6);
  }
}

TEST(RobotPath, StaysClearOfWallsAndComesBackToRooms) {
  const Scene scene = empty_floor(lay_out_floor(4, 8));
  const RobotPath path(scene, 150, 4);
  const FloorMap floor(scene, RobotPath::kClearanceM - 0.05);
  std::vector<std::size_t> rooms;
  for (double t = 0; t < 150; t += 0.1) {
    const Eigen::Vector3d eye = path.world_from_camera(t).translation();
    EXPECT_TRUE(floor.is_free(eye.head<2>())) << t;
    if (const std::size_t room = scene.room_at(eye); room > 0 && (rooms.empty() || rooms.back() != room))
      rooms.push_back(room);
  }
  const std::set<std::size_t> different(rooms.begin(), rooms.end());
  EXPECT_GE(different.size(), 3U);
  EXPECT_LT(different.size(), rooms.size());
}

TEST(WalkPlanner, OnAFloorPeopleWalkThroughDoorsAndKeepClearOfTheCamera) {
  constexpr double kSeconds = 60;
  const Scene scene = empty_floor(lay_out_floor(6, 8));
  const RobotPath path(scene, kSeconds, 6);
  const auto camera_at = [&](double t) { return path.world_from_camera(t); };
  const FloorMap floor(scene);
  const FloorMap walked(scene, FloorMap::kHalfPerson - 0.05);  // a way may cut the corner of a cell
  WalkPlanner planner(floor, {640, 480, 525, 525, 319.5, 239.5, {}}, camera_at, kSeconds);
  planner.walk_through(scene);
  for (const std::uint64_t person : {1U, 2U, 3U}) {
    const Walk walk = planner.plan(1.0, Random(6, person));
    std::set<std::size_t> rooms;
    int near = 0;
    int count = 0;
    for (double t = 0; t < kSeconds; t += 0.1, ++count) {
      const Eigen::Vector2d p = walk.at(t).position;
      EXPECT_TRUE(walked.is_free(p)) << t;
      rooms.insert(scene.room_at({p.x(), p.y(), 0}));
      near += (camera_at(t).translation().head<2>() - p).norm() < 0.6 ? 1 : 0;
    }
    EXPECT_GE(rooms.size(), 2U);
    EXPECT_LT(near, count / 50);
  }
}

}  // namespace
}  // namespace rds::simulator
