// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/building/furnishing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/simulator/world/wall.hpp"

namespace rds::simulator {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

constexpr std::uint64_t kPlacesStream = 11;
constexpr std::uint64_t kMovesStream = 12;
constexpr double kGap = 0.04;              // between neighbours [m]
constexpr double kHalfLane = 0.55;         // of the way from a door to the middle of the room [m]
constexpr double kMoveProbability = 0.25;  // of a small piece per day
constexpr int kAttempts = 60;

/// Width along the wall and depth in front of it [m].
Vector2d size_of(Piece piece) {
  switch (piece) {
    case Piece::kDesk:
      return {1.75, 1.45};
    case Piece::kSofa:
      return {1.95, 0.95};
    case Piece::kTelevision:
      return {1.55, 0.4};
    case Piece::kDining:
      return {2.5, 1.05};
    case Piece::kShelf:
      return {0.98, 0.34};
    case Piece::kPlant:
      return {0.85, 0.85};
    case Piece::kBoxes:
      return {0.62, 0.55};
    case Piece::kFloorLamp:
      return {0.45, 0.45};
    case Piece::kChair:
      return {0.62, 0.7};
  }
  return {0, 0};
}

bool is_small(Piece piece) {
  return piece >= Piece::kPlant;
}

/// Largest pieces first: the small ones find a place between them.
std::vector<Piece> pieces_of(RoomKind kind, double area) {
  using enum Piece;
  switch (kind) {
    case RoomKind::kOffice:
      if (area > 22) return {kDesk, kDesk, kShelf, kShelf, kPlant, kBoxes, kChair, kChair};
      return {kDesk, kShelf, kShelf, kPlant, kBoxes, kChair};
    case RoomKind::kMeeting:
      return {kDining, kTelevision, kShelf, kChair, kChair, kPlant, kFloorLamp};
    case RoomKind::kLounge:
      return {kSofa, kDining, kTelevision, kShelf, kPlant, kPlant, kFloorLamp, kChair};
    case RoomKind::kStore:
      return {kShelf, kShelf, kShelf, kShelf, kShelf, kBoxes, kBoxes, kBoxes, kBoxes, kChair};
    case RoomKind::kCorridor:
      return {kChair, kBoxes};
  }
  return {};
}

/// Places pieces at the walls of one room, one after the other.
class Furnisher {
 public:
  Furnisher(const RoomPlan& room, const std::vector<DoorZone>& doors) {
    const Vector2d half = room.box.size().head<2>() / 2;
    walls_ = walls_of({{-half.x(), -half.y(), 0}, {half.x(), half.y(), room.box.max.z()}});
    const Vector2d middle = (half.array() - 1.55).max(0.5);
    if (room.kind != RoomKind::kCorridor) taken_.emplace_back(-middle, middle);
    for (const DoorZone& door : doors) keep_way(door, room.kind == RoomKind::kCorridor);
  }

  std::optional<Standing> place(Piece piece, Random& random) const {
    const Vector2d size = size_of(piece);
    for (int i = 0; i < kAttempts; ++i) {
      const Wall& wall = walls_[static_cast<std::size_t>(random.integer(4))];
      const double reach = static_cast<double>(wall.length) / 2 - size.x() / 2 - kGap;
      const auto along = static_cast<float>(random.uniform(-1, 1) * reach);
      const AlignedBox2d footprint = footprint_of(wall, along, size);
      if (reach > 0 && is_free(footprint))
        return Standing{piece, wall.stand(along, 0), footprint, random.next()};
    }
    return std::nullopt;
  }

  void take(const AlignedBox2d& footprint) { taken_.push_back(footprint); }
  void release(const AlignedBox2d& footprint) {
    std::erase_if(taken_, [&](const AlignedBox2d& other) { return other.isApprox(footprint); });
  }

 private:
  /// From a door straight on until it meets the middle of the room, and then to the middle.
  void keep_way(const DoorZone& door, bool is_corridor) {
    const Vector2d across(std::abs(door.inward.y()), std::abs(door.inward.x()));
    const double depth = is_corridor ? 1.0 : std::abs(door.inward.dot(door.middle)) + kHalfLane;
    AlignedBox2d way(door.middle);
    way.extend(Vector2d(door.middle + door.inward * depth));
    taken_.emplace_back(way.min() - across * (kHalfLane + 0.1), way.max() + across * (kHalfLane + 0.1));
    if (is_corridor) return;
    AlignedBox2d turn(Vector2d::Zero());
    turn.extend(Vector2d(door.middle.cwiseProduct(across)));
    taken_.emplace_back(turn.min().array() - kHalfLane, turn.max().array() + kHalfLane);
  }

  static AlignedBox2d footprint_of(const Wall& wall, float along, const Vector2d& size) {
    const Vector2d right = wall.right.head<2>().cast<double>();
    const Vector2d inward = wall.inward().head<2>().cast<double>();
    const Vector2d back = wall.middle.head<2>().cast<double>() + right * static_cast<double>(along);
    AlignedBox2d box(Vector2d(back - right * size.x() / 2));
    return box.extend(Vector2d(back + right * size.x() / 2 + inward * size.y()));
  }

  [[nodiscard]] bool is_free(const AlignedBox2d& footprint) const {
    const AlignedBox2d wide(footprint.min().array() - kGap, footprint.max().array() + kGap);
    return std::ranges::none_of(taken_, [&](const AlignedBox2d& other) { return wide.intersects(other); });
  }

  std::array<Wall, 4> walls_{};
  std::vector<AlignedBox2d> taken_;
};

}  // namespace

std::vector<Standing> furnish(const RoomPlan& room, const std::vector<DoorZone>& doors, int day,
                              std::uint64_t own) {
  Furnisher furnisher(room, doors);
  std::vector<Standing> standing;
  Random places(room.style, kPlacesStream);
  const double area = room.box.size().head<2>().prod();
  for (const Piece piece : pieces_of(room.kind, area)) {
    const auto placed = furnisher.place(piece, places);
    if (!placed) continue;
    furnisher.take(placed->footprint);
    standing.push_back(*placed);
  }
  for (int today = 1; today <= day; ++today) {
    Random moves(own + static_cast<std::uint64_t>(today), kMovesStream);
    for (Standing& old : standing) {
      if (!is_small(old.piece) || !moves.chance(kMoveProbability)) continue;
      auto moved = furnisher.place(old.piece, moves);
      if (!moved) continue;
      furnisher.release(old.footprint);
      furnisher.take(moved->footprint);
      moved->look = old.look;
      old = *moved;
    }
  }
  return standing;
}

}  // namespace rds::simulator
