// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tools/simulator/building/floor_layout.hpp"

namespace rds::simulator {

/// What the light of a day is like.
struct DayLight {
  float lamps = 1;     // times the power of the ceiling lamps
  Eigen::Array3f sky;  // of each window, B, G, R
};

/// @param day  0 is the first; the light of each later one is drawn.
DayLight light_of_day(std::uint64_t seed, int day);

/// Ceiling lamps in rows and columns, and the light of the window.
std::vector<Lamp> lamps_of(const RoomPlan& room, const DayLight& light);

}  // namespace rds::simulator
