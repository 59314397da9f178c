// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/simulator/building/floor_layout.hpp"
#include "tools/simulator/building/shell.hpp"
#include "tools/simulator/rendering/random.hpp"
#include "tools/simulator/world/furniture.hpp"

namespace rds::simulator {

/// The materials of a floor. Rooms share them: a texture is painted once, however many rooms there are.
class FloorLooks {
 public:
  FloorLooks(SceneBuilder& builder, std::uint64_t seed);

  /// Of a room; corridors are all alike and have little texture.
  [[nodiscard]] ShellLook shell(const RoomPlan& room) const;
  [[nodiscard]] const Palette& palette(const RoomPlan& room) const;
  [[nodiscard]] std::uint16_t poster(Random& random) const { return drawn(posters_, random); }
  [[nodiscard]] std::uint16_t window(Random& random) const { return drawn(windows_, random); }
  [[nodiscard]] std::uint16_t rug(Random& random) const { return drawn(rugs_, random); }
  /// The n-th plate beside a door.
  [[nodiscard]] std::uint16_t plate(std::size_t n) const { return plates_[n % plates_.size()]; }
  [[nodiscard]] std::uint16_t whiteboard() const { return whiteboard_; }
  [[nodiscard]] std::uint16_t door() const { return door_; }

 private:
  using Materials = std::vector<std::uint16_t>;
  static std::uint16_t drawn(const Materials& materials, Random& random) {
    return materials[static_cast<std::size_t>(random.integer(static_cast<int>(materials.size())))];
  }
  void paint_walls_and_floors(SceneBuilder& builder, Random& random);

  std::vector<Palette> palettes_;
  Materials walls_;
  Materials floors_;
  Materials posters_;
  Materials plates_;
  Materials windows_;
  Materials rugs_;
  ShellLook corridor_;
  std::uint16_t ceiling_ = 0;
  std::uint16_t lamp_ = 0;
  std::uint16_t whiteboard_ = 0;
  std::uint16_t door_ = 0;
};

}  // namespace rds::simulator
