// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace rds::mapper {

/// What a sampled pixel is evidence of. Decided in segmentation/classify.cpp; the values stand in saved
/// records.
enum class PixelClass : std::uint8_t {
  kInvalid = 0,   // no evidence: no depth, or a flying pixel
  kStatic = 1,    // a hit in its voxel, misses along its ray
  kDynamic = 2,   // a miss in its voxel, no ray
  kFar = 3,       // measured beyond max_range_m: misses along its ray up to there
  kNoReturn = 4,  // nothing is measured all around: misses along its ray for uncertain voxels only
  kUnknown = 5,   // static or dynamic; no ray
  kDoubtful = 6,  // static, but near something dynamic; misses along its ray
};
using PixelClasses = std::vector<PixelClass>;

/// What the depth picture shows as a surface, and nothing as dynamic.
inline bool looks_static(PixelClass c) {
  return c == PixelClass::kStatic || c == PixelClass::kDoubtful;
}

}  // namespace rds::mapper
