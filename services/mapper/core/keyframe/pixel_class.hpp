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

/// A voxel that no more keyframes have hit may be an accident.
inline constexpr int kUncertainHits = 2;

// What was measured as a surface is in doubt where
//   a pixel is unknown, or static and near something dynamic (classify()),
//   a place is a ghost or transient (SceneHistory),
//   an occupied voxel is a ghost, or was hit in no more than kUncertainHits keyframes (SemanticOctree).

}  // namespace rds::mapper
