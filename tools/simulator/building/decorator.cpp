// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/building/decorator.hpp"

#include <algorithm>

namespace rds::simulator {
namespace {

constexpr std::uint64_t kPicturesStream = 15;
constexpr float kPosterSpacing = 3.5F;  // in corridors [m]
constexpr float kBesideDoor = 0.1F;     // free [m]
constexpr double kAtWall = 0.02;        // as near as that a piece of furniture stands at a wall [m]

/// Keeps the wall free behind a piece that is as high as pictures hang.
void keep_free_behind(const Standing& piece, const RoomPlan& room, const Wall& wall, WallPictures& pictures) {
  if (piece.piece != Piece::kShelf && piece.piece != Piece::kFloorLamp) return;
  const Eigen::Vector2d foot = wall.middle.head<2>().cast<double>();
  const Eigen::Vector2d right = wall.right.head<2>().cast<double>();
  const Eigen::Vector2d inward = wall.inward().head<2>().cast<double>();
  const Eigen::Vector2d a = in_world(room, piece.footprint.min()) - foot;
  const Eigen::Vector2d b = in_world(room, piece.footprint.max()) - foot;
  if (std::min(a.dot(inward), b.dot(inward)) > kAtWall) return;
  const auto [from, to] = std::minmax({a.dot(right), b.dot(right)});
  pictures.keep_free(static_cast<float>(from), static_cast<float>(to));
}

}  // namespace

void Decorator::decorate(std::size_t index, const RoomPlan& room, const std::vector<Standing>& standing,
                         std::uint64_t own) {
  const auto walls = walls_of(room.box);
  Random places(room.style, kPicturesStream);
  Random choice(own, kPicturesStream);
  const Palette& palette = looks_.palette(room);
  const bool is_corridor = room.kind == RoomKind::kCorridor;
  for (std::size_t side = 0; side < walls.size(); ++side) {
    WallPictures pictures(builder_, walls[side]);
    const auto gaps = gaps_of(scene_, index, walls[side]);
    for (const Gap& gap : gaps) pictures.keep_free(gap.from - kBesideDoor, gap.to + kBesideDoor);
    for (const Standing& piece : standing) keep_free_behind(piece, room, walls[side], pictures);
    if (room.has_window && side == window_side(room))
      pictures.hang_in_the_middle(1.55F, 1.7F, 1.2F, looks_.window(choice), palette.white);
    else if (room.kind == RoomKind::kMeeting && side < kEast)
      pictures.hang_in_the_middle(1.6F, 1.5F, 0.9F, looks_.whiteboard(), palette.metal);
    if (is_corridor) hang_plates(pictures, gaps, palette.metal);
    const int posters =
        is_corridor ? static_cast<int>(walls[side].length / kPosterSpacing) : 2 + places.integer(2);
    pictures.hang_posters(posters, looks_, palette.white, places, choice);
  }
}

void Decorator::hang_plates(WallPictures& pictures, const std::vector<Gap>& gaps, std::uint16_t frame) {
  for (const Gap& gap : gaps) pictures.hang_plate(gap.to + 0.22F, looks_.plate(plates_++), frame);
}

}  // namespace rds::simulator
