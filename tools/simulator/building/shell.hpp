// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "tools/simulator/world/wall.hpp"

namespace rds::simulator {

/// What the shell of a room looks like.
struct ShellLook {
  std::uint16_t wall = 0;
  std::uint16_t floor = 0;
  std::uint16_t ceiling = 0;
  std::uint16_t lamp = 0;
  std::uint16_t trim = 0;
  float wall_metres = 1.6F;  // per repetition of the wall's texture
  float floor_metres = 1.3F;
};

/// A hole in a wall: along the wall, to the right of its middle.
struct Gap {
  float from = 0;
  float to = 0;
  float height = 0;
};

/// The gaps of a wall of `room`, from left to right; Gap::height is that of the opening.
std::vector<Gap> gaps_of(const Scene& scene, std::size_t room, const Wall& wall);

/// Floor, ceiling with its lamps, and walls with their openings, of the room that the builder began last.
void add_shell(SceneBuilder& builder, const Scene& scene, const ShellLook& look);

/// The sides, the top and the threshold of an opening within the wall.
void add_reveal(SceneBuilder& builder, const geometry::Box3& opening, std::uint16_t material);

/// A door's leaf that stands open at a right angle, to the right of a gap as seen from inside.
void add_open_door(SceneBuilder& builder, const Wall& wall, const Gap& gap, std::uint16_t material,
                   std::uint16_t handle);

}  // namespace rds::simulator
