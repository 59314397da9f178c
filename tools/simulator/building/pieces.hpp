// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulator/building/furnishing.hpp"

namespace rds::simulator {

/// The frame of a room, or of a group of things: turned about z only.
struct PlanarFrame {
  float x = 0;
  float y = 0;
  float yaw_rad = 0;

  [[nodiscard]] Place operator*(const Place& place) const;
};

/// Builds a piece of furniture; its look depends on Standing::look alone.
void add_piece(SceneBuilder& builder, const Palette& palette, const PlanarFrame& world_from_room,
               const Standing& standing);

}  // namespace rds::simulator
