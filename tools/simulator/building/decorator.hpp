// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/simulator/building/floor_looks.hpp"
#include "tools/simulator/building/furnishing.hpp"
#include "tools/simulator/building/wall_pictures.hpp"

namespace rds::simulator {

/// Hangs windows, whiteboards, posters and the plates of doors on the walls of a floor, room by room.
class Decorator {
 public:
  /// All outlive it.
  Decorator(SceneBuilder& builder, const Scene& scene, const FloorLooks& looks)
      : builder_(builder), scene_(scene), looks_(looks) {}

  /// @param index     of the room that the builder began last.
  /// @param standing  in the frame of the room: nothing hangs behind what is tall.
  /// @param own       seed of this room alone: which pictures hang where those of one style have others.
  void decorate(std::size_t index, const RoomPlan& room, const std::vector<Standing>& standing,
                std::uint64_t own);

 private:
  void hang_plates(WallPictures& pictures, const std::vector<Gap>& gaps, std::uint16_t frame);

  SceneBuilder& builder_;
  const Scene& scene_;
  const FloorLooks& looks_;
  std::size_t plates_ = 0;
};

}  // namespace rds::simulator
