// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace rds::mapper {

/// What a sampled pixel is evidence of. Decided in evidence/classify.cpp; the values stand in saved records.
enum class PixelClass : std::uint8_t {
  kInvalid = 0,   // no evidence: no depth, a flying pixel, or in doubt and not confirmed
  kStatic = 1,    // a hit in its voxel, misses along its ray
  kDynamic = 2,   // a miss in its voxel, no ray
  kFar = 3,       // measured beyond max_range_m: misses along its ray up to there
  kNoReturn = 4,  // nothing is measured all around: misses along its ray for voxels in doubt only
  kUnknown = 5,   // static or dynamic: resolve() decides with the surface that it belongs to
};
using PixelClasses = std::vector<PixelClass>;

/// Why something that was measured as a surface may not be static.
enum class Doubt : std::uint8_t {
  kNone,
  // Of a pixel, by its own keyframe: classify().
  kBesideDynamic,  // in the rim of a dynamic object, or in a small part of its depth cut
  kMovingCell,     // in a cell of the picture in which the tracker found motion
  kNearDynamic,    // static, but within confirmation.radius_m of something dynamic
  // Of a place, by all keyframes: SceneHistory.
  kTransient,  // static only at times at which others saw something dynamic there, and in fewer keyframes
  kGhost,      // static in fewer keyframes than dynamic, and in none later than the one that asks
  // Of an occupied voxel: SemanticOctree.
  kSeldomSeen,  // hit in no more than octree.weak_sightings keyframes
};

}  // namespace rds::mapper
