// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/visibility.hpp"

#include <gtest/gtest.h>

#include "tools/simulator/camera_path.hpp"

namespace rds::simulator {
namespace {

const geometry::CameraModel kCamera{640, 480, 525, 525, 319.5, 239.5, {}};
constexpr double kDoorWidth = 1.0;

/// Three rooms of 4 × 4 m in a row along x, with doors in the middle of the walls between them.
Scene three_rooms() {
  Scene scene;
  for (const double x : {0.0, 4.1, 8.2}) scene.rooms.push_back({{{x, 0, 0}, {x + 4, 4, 2.6}}, {}, {}, {}});
  for (const std::size_t left : {0U, 1U}) {
    const double x = scene.rooms[left].box.max.x();
    const double half = kDoorWidth / 2;
    scene.openings.push_back({{left, left + 1}, {{x, 2 - half, 0}, {x + 0.1, 2 + half, 2}}});
  }
  return scene;
}

std::vector<std::size_t> seen(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  return visible_rooms(three_rooms(), kCamera, look_at(eye, target));
}

using Rooms = std::vector<std::size_t>;

TEST(VisibleRooms, AllRoomsInARowAreSeenThroughTheirDoors) {
  EXPECT_EQ(seen({1, 2, 1.2}, {9, 2, 1.2}), (Rooms{0, 1, 2}));
}

TEST(VisibleRooms, ADoorBehindTheCameraOrBesideThePictureShowsNothing) {
  EXPECT_EQ(seen({1, 2, 1.2}, {0, 2, 1.2}), Rooms{0});
  EXPECT_EQ(seen({1, 2, 1.2}, {1.5, 4, 1.2}), Rooms{0});
}

TEST(VisibleRooms, TheSecondDoorIsHiddenByTheWallBesideTheFirst) {
  EXPECT_EQ(seen({3, 0.3, 1.2}, {4.05, 2, 1.2}), (Rooms{0, 1}));
}

TEST(VisibleRooms, InADoorwayTheRoomsOnBothSidesAreSeen) {
  EXPECT_EQ(seen({4.05, 2, 1.2}, {4.05, 3, 1.2}), (Rooms{0, 1}));
}

}  // namespace
}  // namespace rds::simulator
