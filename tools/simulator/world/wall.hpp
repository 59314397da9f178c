// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <numbers>

#include "common/geometry/box.hpp"
#include "tools/simulator/world/furniture.hpp"

namespace rds::simulator {

/// One wall: where its inner face is, and how a thing hangs or stands at it.
struct Wall {
  Eigen::Vector3f middle;  // of the wall's foot
  Eigen::Vector3f right;   // unit, as seen from inside
  float yaw_rad;           // of a thing with its back to the wall
  float length;

  [[nodiscard]] Eigen::Vector3f inward() const { return Eigen::Vector3f::UnitZ().cross(right) * -1.0F; }
  /// Where a thing stands `along` to the right of the wall's middle, `distance` in front of it.
  [[nodiscard]] Place stand(float along, float distance, float turn_rad = 0, float z = 0) const {
    const Eigen::Vector3f p = middle + right * along + inward() * distance;
    return {p.x(), p.y(), z, yaw_rad + turn_rad};
  }
};

enum WallSide : std::size_t { kNorth, kSouth, kEast, kWest };  // +y, −y, +x, −x

/// The four walls of a box, by WallSide.
inline std::array<Wall, 4> walls_of(const geometry::Box3& box) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const Eigen::Vector3f low = box.min.cast<float>();
  const Eigen::Vector3f high = box.max.cast<float>();
  const float x = (low.x() + high.x()) / 2;
  const float y = (low.y() + high.y()) / 2;
  const float width = high.x() - low.x();
  const float depth = high.y() - low.y();
  return {{{{x, high.y(), low.z()}, {1, 0, 0}, 0, width},
           {{x, low.y(), low.z()}, {-1, 0, 0}, kPi, width},
           {{high.x(), y, low.z()}, {0, -1, 0}, -kPi / 2, depth},
           {{low.x(), y, low.z()}, {0, 1, 0}, kPi / 2, depth}}};
}

}  // namespace rds::simulator
