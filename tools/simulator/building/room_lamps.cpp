// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/building/room_lamps.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/rendering/random.hpp"
#include "tools/simulator/world/lighting.hpp"
#include "tools/simulator/world/wall.hpp"

namespace rds::simulator {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr std::uint64_t kDayStream = 16;
constexpr float kSpacing = 2.9F;  // of lamps [m]

int lamps_along(float length) {
  return std::max(1, static_cast<int>(std::lround(length / kSpacing)));
}

/// The lamps of a room give as much light as those of the room of make_room() (2.5) and a little more where
/// they are many; a corridor is as bright in the middle as at its ends.
float power_of_each(RoomKind kind, int count) {
  return kind == RoomKind::kCorridor ? 1.1F : 2.5F / static_cast<float>(count) + 0.25F;
}

}  // namespace

DayLight light_of_day(std::uint64_t seed, int day) {
  if (day == 0) return {1, kWindowColor};
  Random random(seed + static_cast<std::uint64_t>(day), kDayStream);
  const auto f = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
  const float lamps = f(0.75, 1.15);
  const float warmth = f(-0.12, 0.12);
  return {lamps, kWindowColor * f(0.3, 1.3) * Eigen::Array3f(1 - warmth, 1, 1 + warmth)};
}

std::vector<Lamp> lamps_of(const RoomPlan& room, const DayLight& light) {
  const Vector2f low = room.box.min.head<2>().cast<float>();
  const Vector2f size = room.box.size().head<2>().cast<float>();
  const auto z = static_cast<float>(room.box.max.z()) - 0.03F;
  const int columns = lamps_along(size.x());
  const int rows = lamps_along(size.y());
  const float power = light.lamps * power_of_each(room.kind, columns * rows);
  std::vector<Lamp> lamps;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const float x = low.x() + size.x() * (static_cast<float>(c) + 0.5F) / static_cast<float>(columns);
      const float y = low.y() + size.y() * (static_cast<float>(r) + 0.5F) / static_cast<float>(rows);
      lamps.push_back({{x, y, z}, {0.6F, 0, 0}, {0, 0.15F, 0}, kLampColor * power});
    }
  if (room.has_window) {
    const Wall wall = walls_of(room.box)[window_side(room)];
    lamps.push_back(
        {wall.middle + wall.inward() * 0.05F + Vector3f(0, 0, 1.6F), {0.8F, 0, 0}, {0, 0, 0.5F}, light.sky});
  }
  return lamps;
}

}  // namespace rds::simulator
