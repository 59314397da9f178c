// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "tools/simulator/people/gait.hpp"
#include "tools/simulator/rendering/mesh.hpp"
#include "tools/simulator/rendering/random.hpp"
#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

/// One person's body and clothes.
struct PersonLook {
  BodyShape body;
  std::uint16_t shirt = 0;
  std::uint16_t sleeves = 0;
  std::uint16_t trousers = 0;
  std::uint16_t skin = 0;
  std::uint16_t head = 0;
  std::uint16_t hair = 0;
  std::uint16_t shoes = 0;
  float sleeve = 1;       // covered share of the arm
  float trouser_leg = 1;  // covered share of the leg
  bool long_hair = false;
  float walking_speed = 1;  // [m/s]
};

/// Dresses somebody; the textures and materials are added to `appearance`.
PersonLook make_person(Appearance& appearance, Random& random);

/// The person's surface at one moment, lit, as triangles of object `object`.
///
/// @param lamps  of the room where the person is
void build_person(const PersonLook& look, const Motion& motion, std::uint16_t object,
                  std::span<const Lamp> lamps, Mesh& mesh);

}  // namespace rds::simulator
