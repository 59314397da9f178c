// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rds::mapper {

/// What one keyframe says about one voxel: the strongest of what its pixels say, the last of these. The
/// numbers' bits are the planes of a KeyframeView.
enum class Observation : std::uint8_t {
  kNone = 0,
  kNoReturn = 1,  // passed by a ray at whose end nothing is measured
  kPassed = 2,    // passed by a ray, or the surface of something dynamic
  kUnknown = 3,   // a surface that is static or a movable object's
  kDoubtful = 4,  // a surface that is static, but near something dynamic
  kStatic = 5,    // a static surface
};

/// A standing person moves by less [m].
inline constexpr double kDynamicCubeM = 0.1;

}  // namespace rds::mapper
