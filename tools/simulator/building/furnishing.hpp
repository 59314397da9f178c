// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/simulator/building/floor_layout.hpp"
#include "tools/simulator/rendering/random.hpp"
#include "tools/simulator/world/furniture.hpp"

namespace rds::simulator {

/// A thing, or things that stand together, with a back that belongs to a wall.
enum class Piece : std::uint8_t {
  kDesk,  // with screens, an office chair, and what lies on it
  kSofa,
  kTelevision,  // on a low shelf
  kDining,      // table and two chairs
  kShelf,
  kPlant,
  kBoxes,
  kFloorLamp,
  kChair
};

/// Where a piece of furniture stands, in the frame of its room.
struct Standing {
  Piece piece = Piece::kChair;
  Place place;                    // middle of its back at the wall
  Eigen::AlignedBox2d footprint;  // [m]
  std::uint64_t look = 0;         // seed of size and textures
};

/// A door or another opening, in the frame of the room.
struct DoorZone {
  Eigen::Vector2d middle;  // of the door, at the wall
  Eigen::Vector2d inward;  // unit
};

/// Furnishes a room of its kind: the ways from the doors to the middle stay free.
///
/// @param doors  in the frame of the room.
/// @param day    0 is the first; on each later day some small pieces of the day before stand elsewhere.
/// @param own    of this room alone, where rooms of one style differ: which pieces move.
std::vector<Standing> furnish(const RoomPlan& room, const std::vector<DoorZone>& doors, int day,
                              std::uint64_t own);

}  // namespace rds::simulator
