// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/building/pieces.hpp"

#include <cmath>
#include <numbers>

namespace rds::simulator {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kTableTop = 0.74F;

/// Builds one piece in the frame of its back: x to the right along the wall as seen from the room, y towards
/// the wall. What is to be turned by `turn` looks along −y at 0.
class PieceMaker {
 public:
  PieceMaker(SceneBuilder& builder, const Palette& palette, const PlanarFrame& world_from_piece,
             std::uint64_t look)
      : builder_(builder), palette_(palette), world_from_piece_(world_from_piece), random_(look) {}

  void make(Piece piece) {
    switch (piece) {
      case Piece::kDesk:
        return desk();
      case Piece::kSofa:
        return add_sofa(builder_, palette_, at(0, 0.47F), f(1.75, 1.9));
      case Piece::kTelevision:
        return television();
      case Piece::kDining:
        return dining();
      case Piece::kShelf:
        return add_shelf(builder_, palette_, at(0, 0.17F), 0.95F, f(1.5, 2.1), random_);
      case Piece::kPlant:
        return add_plant(builder_, palette_, at(0, 0.42F), f(0.9, 1.3), random_);
      case Piece::kBoxes:
        return boxes();
      case Piece::kFloorLamp:
        return add_floor_lamp(builder_, palette_, at(0, 0.23F));
      case Piece::kChair:
        return add_chair(builder_, palette_, at(0, 0.35F, f(-0.3, 0.3)));
    }
  }

 private:
  float f(double low, double high) { return static_cast<float>(random_.uniform(low, high)); }

  /// `distance` in front of the wall.
  [[nodiscard]] Place at(float along, float distance, float turn_rad = 0, float z = 0) const {
    return world_from_piece_ * Place{along, -distance, z, turn_rad};
  }

  void desk() {
    const float width = f(1.5, 1.7);
    add_table(builder_, palette_, at(0, 0.42F), width, 0.8F);
    add_monitor(builder_, palette_, at(-0.36F, 0.32F, f(-0.1, 0.25), kTableTop), f(0.5, 0.6), random_);
    if (random_.chance(0.6))
      add_monitor(builder_, palette_, at(0.34F, 0.3F, f(-0.25, 0.1), kTableTop), f(0.48, 0.56), random_);
    add_desk_clutter(builder_, palette_, at(0, 0.42F, 0, kTableTop), width, random_);
    if (random_.chance(0.6)) add_bottle(builder_, at(-width / 2 + 0.1F, 0.5F, 0, kTableTop), random_);
    add_office_chair(builder_, palette_, at(f(-0.3, 0.3), f(1.05, 1.12), kPi + f(-0.7, 0.7)));
  }

  void television() {
    constexpr float kLow = 0.62F;
    add_shelf(builder_, palette_, at(0, 0.17F), 1.5F, kLow, random_);
    add_monitor(builder_, palette_, at(0, 0.2F, f(-0.1, 0.1), kLow), f(0.85, 1.0), random_);
    add_bottle(builder_, at(0.62F, 0.16F, 0, kLow), random_);
  }

  void dining() {
    add_table(builder_, palette_, at(0, 0.5F), f(1.15, 1.3), 0.8F);
    add_bottle(builder_, at(f(0.1, 0.3), 0.5F, 0, kTableTop), random_);
    add_plant(builder_, palette_, at(-0.3F, 0.45F, 0, kTableTop), f(0.4, 0.5), random_);
    add_chair(builder_, palette_, at(0.93F, 0.5F, -kPi / 2 + f(-0.3, 0.3)));
    add_chair(builder_, palette_, at(-0.93F, 0.5F, kPi / 2 + f(-0.3, 0.3)));
  }

  void boxes() {
    add_cardboard_box(builder_, at(0, 0.27F, f(-0.1, 0.1)), {0.5F, 0.4F, 0.42F}, random_);
    if (random_.chance(0.6))
      add_cardboard_box(builder_, at(0, 0.27F, f(-0.3, 0.3), 0.42F), {0.36F, 0.3F, 0.26F}, random_);
  }

  SceneBuilder& builder_;
  const Palette& palette_;
  PlanarFrame world_from_piece_;
  Random random_;
};

}  // namespace

Place PlanarFrame::operator*(const Place& place) const {
  const float c = std::cos(yaw_rad);
  const float s = std::sin(yaw_rad);
  return {x + c * place.x - s * place.y, y + s * place.x + c * place.y, place.z, yaw_rad + place.yaw_rad};
}

void add_piece(SceneBuilder& builder, const Palette& palette, const PlanarFrame& world_from_room,
               const Standing& standing) {
  const Place place = world_from_room * standing.place;
  PieceMaker(builder, palette, {place.x, place.y, place.yaw_rad}, standing.look).make(standing.piece);
}

}  // namespace rds::simulator
