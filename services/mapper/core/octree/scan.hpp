// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "services/mapper/core/keyframe/keyframe_record.hpp"
#include "services/mapper/core/octree/scan_grid.hpp"

namespace rds::mapper {

/// All pixels of one keyframe that fell into one voxel.
struct SurfaceVoxel {
  std::uint32_t static_pixels = 0;
  std::uint32_t dynamic_pixels = 0;
  std::array<std::uint32_t, 3> rgb_sum{};  // of the static pixels
  std::uint16_t label = 0;                 // majority candidate of the static pixels (Boyer–Moore)
  std::uint32_t label_balance = 0;

  /// The paper's rule per voxel: static pixels insert it unless dynamic ones outnumber them.
  [[nodiscard]] bool is_hit() const { return static_pixels > 0 && static_pixels >= dynamic_pixels; }
};

/// What a keyframe with its pose says about space, each voxel once: surfaces, and where rays passed.
struct Scan {
  ScanGrid grid;
  std::vector<SurfaceVoxel> surfaces;
};

/// Fills `scan` (its memory is reused) from a record; points outside the octree's key range are left out.
/// @param classes  of each pixel, as resolve() gives them.
void cast_rays(const KeyframeRecord& record, std::span<const PixelClass> classes, const OctreeConfig& octree,
               const SamplingConfig& sampling, Scan& scan);

}  // namespace rds::mapper
