// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

/// Light of a ceiling lamp and of a window, B, G, R.
inline const Eigen::Array3f kLampColor(0.93F, 1.0F, 1.05F);
inline const Eigen::Array3f kWindowColor(1.12F, 1.03F, 0.96F);

/// Computes what light falls on every vertex: the lamps of its room, and the light of the surroundings
/// reduced by ambient occlusion; everything that stands in the room casts soft shadows.
void bake_light(Scene& scene);

/// The same light without shadows, for what moves.
Eigen::Array3f light_at(const Eigen::Vector3f& position, const Eigen::Vector3f& normal,
                        std::span<const Lamp> lamps);

}  // namespace rds::simulator
