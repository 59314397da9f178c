// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulator/rendering/random.hpp"
#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

/// Materials that many things share.
struct Palette {
  std::uint16_t oak = 0;
  std::uint16_t walnut = 0;
  std::uint16_t white = 0;
  std::uint16_t black = 0;  // swallows infrared light: depth drops out
  std::uint16_t metal = 0;
  std::uint16_t upholstery = 0;
  std::uint16_t cushion = 0;
  std::uint16_t leaves = 0;
  std::uint16_t pot = 0;
  std::uint16_t books = 0;
  std::uint16_t paper = 0;
};

Palette make_palette(SceneBuilder& builder, Random& random);

/// Where a thing stands: its front looks along −y when yaw is 0.
struct Place {
  float x = 0;
  float y = 0;
  float z = 0;
  float yaw_rad = 0;
};

void add_table(SceneBuilder& builder, const Palette& palette, const Place& place, float width, float depth);
void add_chair(SceneBuilder& builder, const Palette& palette, const Place& place);
void add_office_chair(SceneBuilder& builder, const Palette& palette, const Place& place);
void add_monitor(SceneBuilder& builder, const Palette& palette, const Place& place, float width,
                 Random& random);
void add_sofa(SceneBuilder& builder, const Palette& palette, const Place& place, float width);
void add_plant(SceneBuilder& builder, const Palette& palette, const Place& place, float height,
               Random& random);
void add_bottle(SceneBuilder& builder, const Place& place, Random& random);
void add_shelf(SceneBuilder& builder, const Palette& palette, const Place& place, float width, float height,
               Random& random);
void add_cardboard_box(SceneBuilder& builder, const Place& place, const Eigen::Vector3f& size,
                       Random& random);
void add_desk_clutter(SceneBuilder& builder, const Palette& palette, const Place& place, float width,
                      Random& random);
/// A picture in a frame with its back at `place`.
void add_framed_panel(SceneBuilder& builder, const Place& place, float width, float height,
                      std::uint16_t picture, std::uint16_t frame);
void add_floor_lamp(SceneBuilder& builder, const Palette& palette, const Place& place);

}  // namespace rds::simulator
