// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/simulator/building/floor_looks.hpp"
#include "tools/simulator/world/wall.hpp"

namespace rds::simulator {

/// Hangs pictures on one wall where neither a door, a window nor a tall piece of furniture is.
class WallPictures {
 public:
  WallPictures(SceneBuilder& builder, const Wall& wall) : builder_(builder), wall_(wall) {}

  void keep_free(float from, float to) { taken_.push_back({from, to}); }
  /// In the middle of the wall, if it is free.
  void hang_in_the_middle(float z, float width, float height, std::uint16_t picture, std::uint16_t frame);
  /// The plate beside a door.
  void hang_plate(float along, std::uint16_t picture, std::uint16_t frame);
  /// @param places    where and how large: the same for rooms of one style.
  /// @param pictures  which ones: of this room alone.
  void hang_posters(int count, const FloorLooks& looks, std::uint16_t frame, Random& places,
                    Random& pictures);

 private:
  struct Interval {
    float from = 0;
    float to = 0;
  };
  [[nodiscard]] bool is_free(float from, float to) const;

  SceneBuilder& builder_;
  const Wall& wall_;
  std::vector<Interval> taken_;
};

}  // namespace rds::simulator
