// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/world/wall.hpp"

namespace rds::simulator {

enum class RoomKind : std::uint8_t { kCorridor, kOffice, kMeeting, kLounge, kStore };

/// A room before anything stands in it.
struct RoomPlan {
  geometry::Box3 box;  // between the inner faces of its walls, in the world [m]
  RoomKind kind = RoomKind::kOffice;
  std::uint64_t style = 0;  // rooms of one style look alike
  bool is_turned = false;   // by 180° against its own frame, in which its door is in the south (−y)
  bool has_window = false;  // in the wall opposite to the door
};

inline WallSide door_side(const RoomPlan& room) {
  return room.is_turned ? kNorth : kSouth;
}
inline WallSide window_side(const RoomPlan& room) {
  return room.is_turned ? kSouth : kNorth;
}

/// Between the world and the frame of a room: origin in the middle of its floor, door in the south.
inline Eigen::Vector2d in_room(const RoomPlan& room, const Eigen::Vector2d& in_world) {
  return (room.is_turned ? -1 : 1) * (in_world - room.box.center().head<2>());
}
inline Eigen::Vector2d in_world(const RoomPlan& room, const Eigen::Vector2d& in_room) {
  return room.box.center().head<2>() + (room.is_turned ? -1 : 1) * in_room;
}

/// Where the rooms of a floor are. Openings with a door are between a corridor and a room, or two rooms;
/// pieces of corridor are open to each other over their whole height.
struct FloorLayout {
  std::vector<RoomPlan> rooms;  // corridors first
  std::vector<Opening> openings;
};

inline constexpr int kFewestRooms = 8;
inline constexpr int kMostRooms = 30;
inline constexpr float kWallThicknessM = 0.12F;

/// Rooms on both sides of a corridor; from ten rooms on, of a corridor that runs in a ring. In each row two
/// rooms look alike: they have the same size, door and furniture.
///
/// @param rooms  without corridors, kFewestRooms … kMostRooms.
FloorLayout lay_out_floor(std::uint64_t seed, int rooms);

}  // namespace rds::simulator
