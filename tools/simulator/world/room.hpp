// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

/// A furnished room with baked light: desk at the north wall (+y), seats along the others, free floor in the
/// middle.
///
/// The seed chooses size, colours, textures, and where and how things stand.
Scene make_room(std::uint64_t seed);

}  // namespace rds::simulator
