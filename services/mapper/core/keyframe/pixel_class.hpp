// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace rds::mapper {

/// What a sampled pixel is evidence of. Decided in evidence/classify.cpp; the values stand in saved records.
enum class PixelClass : std::uint8_t {
  kInvalid = 0,   // no evidence: no depth, a flying pixel, or unconfirmed
  kStatic = 1,    // a hit in its voxel, misses along its ray
  kDynamic = 2,   // a miss in its voxel, no ray
  kFar = 3,       // measured beyond max_range_m: misses along its ray up to there
  kNoReturn = 4,  // nothing is measured all around: misses along its ray for uncertain voxels only
  kUnknown = 5,   // static or dynamic: resolve() decides with the surface that it belongs to
};
using PixelClasses = std::vector<PixelClass>;

// Other words for what is not decided, each in one place:
//   an unconfirmed pixel is unknown, or static and near something dynamic (classify()),
//   a ghost is a voxel that was dynamic in more keyframes than static (SceneHistory),
//   a transient one was static only at times at which it was seen as dynamic, too (SceneHistory),
//   an uncertain one is occupied, and a ghost or hit in no more than kUncertainHits keyframes
//   (SemanticOctree).

/// A voxel that no more keyframes have hit may be an accident.
inline constexpr int kUncertainHits = 2;

}  // namespace rds::mapper
