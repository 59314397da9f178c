// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

/// Computes what light falls on every vertex of the room: two ceiling lamps, a window in the west, and the
/// light of the surroundings reduced by ambient occlusion; everything that stands in the room casts soft
/// shadows.
void bake_light(Scene& scene);

/// The same light without shadows, for what moves.
///
/// @param room  Scene::size
Eigen::Array3f light_at(const Eigen::Vector3f& position, const Eigen::Vector3f& normal,
                        const Eigen::Vector3f& room);

}  // namespace rds::simulator
