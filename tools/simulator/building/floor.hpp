// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

/// A floor of a building with baked light: rooms along corridors (lay_out_floor()), furnished each in its
/// kind.
///
/// The seed chooses layout, colours, textures, and where and how things stand.
///
/// @param rooms  without corridors, kFewestRooms … kMostRooms.
/// @param day    0 is the first; on each later one some small furniture has moved, and the light is another.
Scene make_floor(std::uint64_t seed, int rooms, int day);

}  // namespace rds::simulator
