// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/evidence/observation.hpp"
#include "services/mapper/core/evidence/sightings.hpp"
#include "services/mapper/core/keyframe/keyframe_record.hpp"
#include "services/mapper/core/scan/scan_grid.hpp"

namespace rds::mapper {

/// All pixels of one keyframe that fell into one voxel.
struct SurfaceVoxel {
  static constexpr std::uint32_t kNoPixel = 0xFFFF'FFFF;
  octomap::OcTreeKey key;
  std::uint32_t static_pixels = 0;
  std::uint32_t doubtful_pixels = 0;
  std::uint32_t unknown_pixels = 0;
  std::uint32_t dynamic_pixels = 0;
  std::uint32_t first_pixel = kNoPixel;
  std::uint32_t ray_end = kNoPixel;        // its first static or doubtful pixel
  std::array<std::uint32_t, 3> rgb_sum{};  // of the static and doubtful pixels
  std::uint16_t surface = 0;               // of the picture: its first pixel's that is of one
  std::uint16_t label = 0;                 // majority candidate of these (Boyer–Moore)
  std::uint32_t label_balance = 0;

  /// The paper's rule per voxel: static pixels insert it unless dynamic ones outnumber them.
  [[nodiscard]] Observation observation() const;
};

/// What a keyframe with its pose says about space, each voxel once: surfaces, and where rays passed.
struct Scan {
  ScanGrid grid;
  std::vector<SurfaceVoxel> surfaces;
  std::vector<PerCell<std::uint32_t>> slots;    // by the grid's blocks: of kSurface cells, their surfaces
  std::vector<std::uint16_t> surface_of_pixel;  // as find_surfaces() gives them
  std::uint16_t surfaces_of_picture = 0;
  std::vector<Eigen::Vector3d> ray_ends;  // scratch
};

/// Fills `scan` (its memory is reused) with the surface voxels of a record; points outside the octree's key
/// range are left out.
void find_surface_voxels(const KeyframeRecord& record, const OctreeConfig& octree,
                         const SamplingConfig& sampling, Scan& scan);

/// Adds where rays passed and where something dynamic was. @param scan  with the record's surfaces.
void cast_rays(const KeyframeRecord& record, const OctreeConfig& octree, const SamplingConfig& sampling,
               Scan& scan);

}  // namespace rds::mapper
