// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/scan/scan.hpp"

#include <algorithm>
#include <cmath>

#include "services/mapper/core/keyframe/voxel_projector.hpp"

namespace rds::mapper {
namespace {

/// Voxels of a dynamic cube's side, log2.
unsigned cube_bits(double resolution_m) {
  return static_cast<unsigned>(std::max(0L, std::lround(std::log2(kDynamicCubeM / resolution_m))));
}

void add_pixel(SurfaceVoxel& voxel, const KeyframeRecord& record, std::size_t pixel) {
  switch (record.classes[pixel]) {
    case PixelClass::kDynamic:
      ++voxel.dynamic_pixels;
      return;
    case PixelClass::kUnknown:
      ++voxel.unknown_pixels;
      return;
    case PixelClass::kDoubtful:
      ++voxel.doubtful_pixels;
      break;
    default:
      ++voxel.static_pixels;
      break;
  }
  if (voxel.ray_end == SurfaceVoxel::kNoPixel) voxel.ray_end = static_cast<std::uint32_t>(pixel);
  for (std::size_t c = 0; c < 3; ++c) voxel.rgb_sum[c] += record.rgb[3 * pixel + c];
  const std::uint16_t label = record.objects.labels.empty() ? std::uint16_t{0} : record.objects.labels[pixel];
  if (voxel.label_balance == 0) voxel.label = label;
  voxel.label_balance = voxel.label == label ? voxel.label_balance + 1 : voxel.label_balance - 1;
}

/// Index of a voxel's surface, made if there is none yet.
std::uint32_t slot_of(const octomap::OcTreeKey& key, std::size_t pixel, Scan& scan) {
  const std::size_t block = scan.grid.block_of(key);
  if (block >= scan.slots.size()) scan.slots.resize(block + 1);
  std::uint32_t& slot = scan.slots[block][cell_of(key)];
  std::uint8_t& flags = scan.grid.flags_of(key);
  if ((flags & kSurface) == 0) {
    flags |= kSurface;
    slot = static_cast<std::uint32_t>(scan.surfaces.size());
    scan.surfaces.push_back({.key = key, .first_pixel = static_cast<std::uint32_t>(pixel)});
  }
  return slot;
}

/// Where rays end, one per voxel.
class RayEnds {
 public:
  RayEnds(const VoxelProjector& projector, Scan& scan) : projector_(projector), scan_(scan) {}

  void add(std::size_t pixel) {
    VoxelPoint point;
    if (!projector_.project(pixel, projector_.record().classes[pixel], point)) return;
    if (!run_.begins_with(point.packed_key)) return;
    std::uint8_t& flags = scan_.grid.flags_of(point.key());
    if ((flags & kRayCast) == 0) scan_.ray_ends.emplace_back(point.at.head<3>());
    flags |= kRayCast;
  }
  void add_all(PixelClass of_class) {
    const PixelClasses& classes = projector_.record().classes;
    for (std::size_t i = 0; i < classes.size(); ++i)
      if (classes[i] == of_class) add(i);
  }
  /// Casts the rays.
  void cast(ScanFlag flag) {
    scan_.grid.cast_rays(projector_.origin(), scan_.ray_ends, flag);
    scan_.ray_ends.clear();
  }

 private:
  const VoxelProjector& projector_;
  Scan& scan_;
  VoxelRun run_;
};

/// Rays to static and doubtful surfaces, to what is far, and to what is not measured.
void carve(const VoxelProjector& projector, Scan& scan) {
  RayEnds ends(projector, scan);
  for (const SurfaceVoxel& voxel : scan.surfaces)
    if (voxel.ray_end != SurfaceVoxel::kNoPixel) ends.add(voxel.ray_end);
  ends.add_all(PixelClass::kFar);
  ends.cast(kFreeSpace);
  ends.add_all(PixelClass::kNoReturn);
  ends.cast(kNoReturnRay);
}

/// Marks the cubes within half a cube of a voxel.
void mark_around(const octomap::OcTreeKey& key, unsigned bits, ScanGrid& grid) {
  const int side = 1 << bits;
  for (int corner = 0; corner < 8; ++corner) {
    const auto first = [&](unsigned axis) {
      return (key[axis] + ((corner >> axis & 1) != 0 ? side / 2 : -side / 2)) >> bits << bits;
    };
    const auto at = [](int k) { return static_cast<std::uint16_t>(k); };
    const octomap::OcTreeKey lowest(at(first(0)), at(first(1)), at(first(2)));
    if ((grid.flags_of(lowest) & kDynamicPlace) != 0) continue;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
          grid.flags_of({at(lowest[0] + x), at(lowest[1] + y), at(lowest[2] + z)}) |= kDynamicPlace;
  }
}

void mark_dynamic_places(const VoxelProjector& projector, const SamplingConfig& sampling, unsigned bits,
                         ScanGrid& grid) {
  const KeyframeRecord& record = projector.record();
  const auto nearest = static_cast<float>(sampling.min_range_m);
  const auto farthest = static_cast<float>(sampling.max_range_m);
  VoxelRun run;
  VoxelPoint point;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!is_dynamic(record, i) || record.depth_m(i) < nearest || record.depth_m(i) > farthest) continue;
    if (!projector.project(i, PixelClass::kDynamic, point) || !run.begins_with(point.packed_key)) continue;
    std::uint8_t& flags = grid.flags_of(point.key());
    if ((flags & kDynamicSurface) != 0) continue;
    flags |= kDynamicSurface;
    mark_around(point.key(), bits, grid);
  }
}

/// Makes the grid cover all that the record can show, and the cubes around it.
void cover(const VoxelProjector& projector, double resolution_m, ScanGrid& grid) {
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(2 << cube_bits(resolution_m));
  const auto key_at = [](const Eigen::Vector3d& p) {
    const auto key = p.cwiseMax(0).cwiseMin(65535).cast<std::uint16_t>();
    return octomap::OcTreeKey(key.x(), key.y(), key.z());
  };
  grid.reset(key_at(projector.view().min() - around), key_at(projector.view().max() + around));
}

}  // namespace

Observation SurfaceVoxel::observation() const {
  const std::uint32_t still = static_pixels + doubtful_pixels;
  if (still > 0 && still >= dynamic_pixels)
    return static_pixels >= doubtful_pixels ? Observation::kStatic : Observation::kDoubtful;
  return unknown_pixels > dynamic_pixels ? Observation::kUnknown : Observation::kPassed;
}

void find_surface_voxels(const KeyframeRecord& record, const OctreeConfig& octree,
                         const SamplingConfig& sampling, Scan& scan) {
  const VoxelProjector projector(record, octree.resolution_m, sampling.max_range_m);
  scan.surfaces.clear();
  if (!projector.is_inside()) return scan.grid.reset({0, 0, 0}, {0, 0, 0});
  cover(projector, octree.resolution_m, scan.grid);
  VoxelRun run;
  std::uint32_t slot = 0;
  VoxelPoint point;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const PixelClass its_class = record.classes[i];
    if (its_class == PixelClass::kFar || its_class == PixelClass::kNoReturn ||
        !projector.project(i, its_class, point))
      continue;
    if (run.begins_with(point.packed_key)) slot = slot_of(point.key(), i, scan);
    SurfaceVoxel& voxel = scan.surfaces[slot];
    if (voxel.surface == 0) voxel.surface = scan.surface_of_pixel[i];
    add_pixel(voxel, record, i);
  }
}

void cast_rays(const KeyframeRecord& record, const OctreeConfig& octree, const SamplingConfig& sampling,
               Scan& scan) {
  const VoxelProjector projector(record, octree.resolution_m, sampling.max_range_m);
  if (!projector.is_inside()) return;
  mark_dynamic_places(projector, sampling, cube_bits(octree.resolution_m), scan.grid);
  if (!octree.carve_rays) return;
  carve(projector, scan);
  for (const SurfaceVoxel& voxel : scan.surfaces)
    if (voxel.observation() >= Observation::kUnknown) scan.grid.mark_beside(voxel.key);
}

}  // namespace rds::mapper
