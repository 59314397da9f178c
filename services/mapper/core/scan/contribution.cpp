// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/scan/contribution.hpp"

#include <algorithm>

#include "services/mapper/core/segmentation/depth_surfaces.hpp"

namespace rds::mapper {
namespace {

constexpr double kLargeSurface = 0.1;            // of the picture
constexpr std::uint16_t kMostSurfaces = 0x7FFF;  // those beyond are none

Contribution::Surface surface_of(const SurfaceVoxel& voxel, const KeyframeRecord& record) {
  Contribution::Surface surface{voxel.key, {{}, voxel.label, record.objects.looked_for, voxel.beside}};
  const std::uint32_t pixels = voxel.static_pixels + voxel.doubtful_pixels;
  for (std::size_t c = 0; c < 3; ++c)
    surface.look.rgb[c] = static_cast<std::uint8_t>((voxel.rgb_sum[c] + pixels / 2) / pixels);
  return surface;
}

std::vector<Contribution::Surface> surfaces_in(const Scan& scan, const KeyframeRecord& record) {
  std::vector<Contribution::Surface> surfaces;
  surfaces.reserve(scan.surfaces.size());
  for (const SurfaceVoxel& voxel : scan.surfaces)
    if (voxel.observation() >= Observation::kDoubtful) surfaces.push_back(surface_of(voxel, record));
  return surfaces;
}

SurfacePart part_of(const SurfaceVoxel& voxel) {
  SurfacePart part{};
  part.surface = static_cast<unsigned>(voxel.surface < kMostSurfaces ? voxel.surface : 0) & kMostSurfaces;
  part.is_labelled = voxel.label != 0 ? 1U : 0U;
  return part;
}

/// Which surfaces fill much of the picture, as walls and floors do.
std::vector<bool> large_surfaces(const Scan& scan) {
  std::vector<std::size_t> pixels(std::min<std::size_t>(scan.surfaces_of_picture + 1U, kMostSurfaces));
  for (const auto surface : scan.surface_of_pixel)
    if (surface < pixels.size()) ++pixels[surface];
  std::vector<bool> is_large(pixels.size());
  for (std::size_t s = 1; s < pixels.size(); ++s)
    is_large[s] =
        static_cast<double>(pixels[s]) >= kLargeSurface * static_cast<double>(scan.surface_of_pixel.size());
  return is_large;
}

BlockMask& cells_with(Observation observation, BlockSight& sight) {
  switch (observation) {
    case Observation::kStatic:
      return sight.stable;
    case Observation::kDoubtful:
      return sight.doubtful;
    case Observation::kUnknown:
      return sight.unknown;
    default:
      return sight.passed;
  }
}

/// A ray passes only where no surface of the same picture is next: depth and pose are known to about a voxel,
/// and rays along a floor go through voxels of it that lie between its pixels.
/// @param parts  of the surfaces' voxels.
BlockSight sight_of(const ScanGrid::Block& block, const Scan& scan, std::vector<SurfacePart>& parts) {
  const BlockMask surfaces = block.cells(kSurface);
  BlockSight sight;
  sight.passed = block.cells(kFreeSpace) & ~(surfaces | block.cells(kBesideSurface));
  sight.no_return = block.cells(kNoReturnRay) & ~(surfaces | sight.passed);
  sight.near_dynamic = block.cells(kDynamicPlace);
  parts.clear();
  surfaces.for_each([&](std::size_t cell) {
    const SurfaceVoxel& voxel = scan.surfaces[block.slot[cell]];
    const Observation observation = voxel.observation();
    cells_with(observation, sight).insert(cell);
    if (observation >= Observation::kUnknown) parts.push_back(part_of(voxel));
  });
  return sight;
}

}  // namespace

Contribution contribution_of(const KeyframeRecord& record, const OctreeConfig& octree,
                             const SamplingConfig& sampling, Scan& scan) {
  scan.surfaces_of_picture = find_surfaces(record, scan.surface_of_pixel);
  find_surface_voxels(record, octree, sampling, scan);
  cast_rays(record, octree, sampling, scan);
  Contribution contribution;
  contribution.surfaces = surfaces_in(scan, record);
  contribution.view.set_surfaces(large_surfaces(scan));
  std::vector<SurfacePart> parts;
  for (const auto& block : scan.grid.blocks()) {
    const BlockSight sight = sight_of(block, scan, parts);
    if (!sight.empty()) contribution.view.add(block.key, sight, parts);
  }
  return contribution;
}

std::vector<Contribution::Surface> surfaces_of(const KeyframeRecord& record, const OctreeConfig& octree,
                                               const SamplingConfig& sampling, Scan& scan) {
  scan.surface_of_pixel.clear();
  find_surface_voxels(record, octree, sampling, scan);
  return surfaces_in(scan, record);
}

}  // namespace rds::mapper
