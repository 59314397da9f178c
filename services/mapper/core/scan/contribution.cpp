// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/scan/contribution.hpp"

#include <algorithm>

#include "services/mapper/core/segmentation/depth_surfaces.hpp"

namespace rds::mapper {
namespace {

constexpr double kLargeSurface = 0.1;            // of the picture
constexpr std::uint16_t kMostSurfaces = 0x7FFF;  // those beyond are none

/// Labels, each once, of objects of which the pixel is within half a box's size; 0: none.
std::array<std::uint16_t, 4> objects_around(const KeyframeRecord& record, std::size_t pixel) {
  std::array<std::uint16_t, 4> labels{};
  auto next = labels.begin();
  const double x = record.grid.column(pixel) * record.grid.stride;
  const double y = record.grid.row(pixel) * record.grid.stride;
  for (const ObjectSighting& sighting : record.objects.sightings) {
    const geometry::Box2& box = sighting.box_px;
    const double dx = box.width() / 2;
    const double dy = box.height() / 2;
    const bool is_around = geometry::Box2{box.x0 - dx, box.y0 - dy, box.x1 + dx, box.y1 + dy}.contains(x, y);
    if (is_around && next != labels.end() && std::find(labels.begin(), next, sighting.label) == next)
      *next++ = sighting.label;
  }
  return labels;
}

SurfaceLook look_of(const SurfaceVoxel& voxel, const KeyframeRecord& record) {
  SurfaceLook look{{}, voxel.label, record.objects.looked_for, objects_around(record, voxel.first_pixel)};
  const std::uint32_t pixels = voxel.static_pixels + voxel.doubtful_pixels;
  for (std::size_t c = 0; c < 3; ++c)
    look.rgb[c] = static_cast<std::uint8_t>((voxel.rgb_sum[c] + pixels / 2) / pixels);
  return look;
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

/// What a scan says of one block.
struct ScannedBlock {
  BlockSight sight;
  std::vector<SurfacePart> parts;  // of the surfaces' voxels
  std::vector<SurfaceLook> looks;  // of the static and doubtful ones
};

/// A ray passes only where no surface of the same picture is next: depth and pose are known to about a voxel,
/// and rays along a floor go through voxels of it that lie between its pixels.
/// @param scanned  its memory is reused.
void look_at(std::size_t block, const Scan& scan, const KeyframeRecord& record, ScannedBlock& scanned) {
  const FlaggedCells cells(scan.grid.blocks()[block].flags);
  const BlockMask& surfaces = cells.with(kSurface);
  auto& [sight, parts, looks] = scanned;
  sight = {};
  sight.passed = cells.with(kFreeSpace) & ~(surfaces | cells.with(kBesideSurface));
  sight.no_return = cells.with(kNoReturnRay) & ~(surfaces | sight.passed);
  sight.near_dynamic = cells.with(kDynamicPlace);
  parts.clear();
  looks.clear();
  surfaces.for_each([&](std::size_t cell) {
    const SurfaceVoxel& voxel = scan.surfaces[scan.slots[block][cell]];
    const Observation observation = voxel.observation();
    cells_with(observation, sight).insert(cell);
    if (observation >= Observation::kUnknown) parts.push_back(part_of(voxel));
    if (observation >= Observation::kDoubtful) looks.push_back(look_of(voxel, record));
  });
}

}  // namespace

KeyframeView contribution_of(const KeyframeRecord& record, const OctreeConfig& octree,
                             const SamplingConfig& sampling, Scan& scan) {
  scan.surfaces_of_picture = find_surfaces(record, scan.surface_of_pixel);
  find_surface_voxels(record, octree, sampling, scan);
  cast_rays(record, octree, sampling, scan);
  KeyframeView view;
  view.set_surfaces(large_surfaces(scan));
  ScannedBlock scanned;
  for (std::size_t block = 0; block < scan.grid.blocks().size(); ++block) {
    look_at(block, scan, record, scanned);
    if (!scanned.sight.empty())
      view.add(scan.grid.blocks()[block].key, scanned.sight, scanned.parts, scanned.looks);
  }
  return view;
}

}  // namespace rds::mapper
