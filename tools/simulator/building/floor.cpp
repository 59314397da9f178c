// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/building/floor.hpp"

#include <numbers>

#include "tools/simulator/building/decorator.hpp"
#include "tools/simulator/building/pieces.hpp"
#include "tools/simulator/building/room_lamps.hpp"
#include "tools/simulator/world/lighting.hpp"

namespace rds::simulator {
namespace {

constexpr std::uint64_t kRoomStream = 1000;  // and the room's number: what is of one room alone
constexpr std::uint64_t kDoorStream = 17;

/// Builds the floor room by room.
class FloorMaker {
 public:
  FloorMaker(std::uint64_t seed, int rooms, int day)
      : seed_(seed),
        day_(day),
        light_(light_of_day(seed, day)),
        layout_(lay_out_floor(seed, rooms)),
        builder_(scene_),
        looks_(builder_, seed),
        decorator_(builder_, scene_, looks_) {
    scene_.openings = layout_.openings;
    for (std::size_t i = 0; i < layout_.rooms.size(); ++i) add_room(i);
    bake_light(scene_);
  }

  Scene take() && { return std::move(scene_); }

 private:
  void add_room(std::size_t index) {
    const RoomPlan& room = layout_.rooms[index];
    const std::uint64_t own = Random(seed_, kRoomStream + index).next();
    builder_.begin_room(room.box, lamps_of(room, light_));
    add_shell(builder_, scene_, looks_.shell(room));
    add_doors(index);
    const auto standing = furnish(room, doors_of(index), day_, own);
    for (const Standing& piece : standing) add_piece(builder_, looks_.palette(room), frame_of(room), piece);
    decorator_.decorate(index, room, standing, own);
  }

  static PlanarFrame frame_of(const RoomPlan& room) {
    const Eigen::Vector3f middle = room.box.center().cast<float>();
    return {middle.x(), middle.y(), room.is_turned ? std::numbers::pi_v<float> : 0};
  }

  /// What an opening looks like is of the second of its rooms; a door opens into the room, beside the
  /// corridor.
  void add_doors(std::size_t index) {
    const RoomPlan& room = layout_.rooms[index];
    for (const Opening& opening : scene_.openings)
      if (opening.rooms[1] == index && opening.box.size().head<2>().minCoeff() > 0)
        add_reveal(builder_, opening.box, looks_.shell(room).trim);
    if (room.kind == RoomKind::kCorridor) return;
    Random random(room.style, kDoorStream);
    const Wall wall = walls_of(room.box)[door_side(room)];
    for (const Gap& gap : gaps_of(scene_, index, wall))
      if (random.chance(0.6)) add_open_door(builder_, wall, gap, looks_.door(), looks_.palette(room).metal);
  }

  [[nodiscard]] std::vector<DoorZone> doors_of(std::size_t index) const {
    const RoomPlan& room = layout_.rooms[index];
    std::vector<DoorZone> doors;
    for (const Wall& wall : walls_of(room.box))
      for (const Gap& gap : gaps_of(scene_, index, wall)) {
        const Eigen::Vector3f at = wall.middle + wall.right * ((gap.from + gap.to) / 2);
        const Eigen::Vector2d middle = in_room(room, at.head<2>().cast<double>());
        const Eigen::Vector2d ahead = in_room(room, (at + wall.inward()).head<2>().cast<double>());
        doors.push_back({middle, ahead - middle});
      }
    return doors;
  }

  std::uint64_t seed_;
  int day_;
  DayLight light_;
  FloorLayout layout_;
  Scene scene_;
  SceneBuilder builder_;
  FloorLooks looks_;
  Decorator decorator_;
};

}  // namespace

Scene make_floor(std::uint64_t seed, int rooms, int day) {
  return FloorMaker(seed, rooms, day).take();
}

}  // namespace rds::simulator
