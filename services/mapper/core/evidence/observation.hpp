// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "services/mapper/core/keyframe/voxel_key.hpp"

namespace rds::mapper {

/// What one keyframe says about one voxel: the strongest of what its pixels say, the last of these.
enum class Observation : std::uint8_t {
  kNone = 0,
  kNoReturn = 1,  // passed by a ray at whose end nothing is measured
  kPassed = 2,    // passed by a ray, or the surface of something dynamic
  kUnknown = 3,   // a surface that is static or a movable object's
  kDoubtful = 4,  // a surface that is static, but near something dynamic
  kStatic = 5,    // a static surface
};

/// Set beside the observation where something dynamic was within half a cube (kDynamicCubeM).
inline constexpr std::uint8_t kNearDynamic = 8;
inline constexpr std::uint8_t kObservationBits = 7;
inline Observation observation_in(std::uint8_t cell) {
  return static_cast<Observation>(cell & kObservationBits);
}
inline constexpr unsigned kBitsOfObservation = 4;

/// A standing person moves by less [m].
inline constexpr double kDynamicCubeM = 0.1;

/// An observation, and perhaps kNearDynamic, for each cell.
using BlockObservations = std::array<std::uint8_t, kBlockCells>;

}  // namespace rds::mapper
