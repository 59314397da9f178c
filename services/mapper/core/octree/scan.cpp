// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/scan.hpp"

#include "services/mapper/core/keyframe/voxel_projector.hpp"

namespace rds::mapper {
namespace {

void add_pixel(SurfaceVoxel& voxel, const KeyframeRecord& record, PixelClass its_class, std::size_t pixel) {
  if (its_class == PixelClass::kDynamic) {
    ++voxel.dynamic_pixels;
    return;
  }
  ++voxel.static_pixels;
  for (std::size_t c = 0; c < 3; ++c) voxel.rgb_sum[c] += record.rgb[3 * pixel + c];
  const std::uint16_t label = record.objects.labels.empty() ? std::uint16_t{0} : record.objects.labels[pixel];
  if (voxel.label_balance == 0) voxel.label = label;
  voxel.label_balance = voxel.label == label ? voxel.label_balance + 1 : voxel.label_balance - 1;
}

/// Index of a voxel's surface, made if there is none yet.
std::uint32_t slot_of(const octomap::OcTreeKey& key, Scan& scan) {
  auto& block = scan.grid.block_of(key);
  const auto cell = ScanGrid::cell_of(key);
  if ((block.flags[cell] & kSurface) == 0) {
    block.flags[cell] |= kSurface;
    block.slot[cell] = static_cast<std::uint32_t>(scan.surfaces.size());
    scan.surfaces.emplace_back();
  }
  return block.slot[cell];
}

void mark_surfaces(const VoxelProjector& project, std::span<const PixelClass> classes, Scan& scan) {
  const auto& record = project.record;
  VoxelRun run;
  std::uint32_t slot = 0;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (classes[i] == PixelClass::kFar || classes[i] == PixelClass::kNoReturn ||
        !project.point(i, classes[i], at))
      continue;
    if (const auto key = key_at(at); run.begins_with(key)) slot = slot_of(key, scan);
    add_pixel(scan.surfaces[slot], record, classes[i], i);
  }
}

/// One ray per voxel in which a ray ends, to the first pixel in it that is a `no_return` or, if not, static
/// or far.
void carve(const VoxelProjector& project, std::span<const PixelClass> classes, bool no_return, Scan& scan) {
  VoxelRun run;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i] == PixelClass::kDynamic || (classes[i] == PixelClass::kNoReturn) != no_return) continue;
    if (!project.point(i, classes[i], at)) continue;
    const auto key = key_at(at);
    if (!run.begins_with(key)) continue;
    auto& flags = scan.grid.block_of(key).flags[ScanGrid::cell_of(key)];
    if ((flags & kRayCast) != 0) continue;
    flags |= kRayCast;
    scan.grid.cast_ray(project.origin, at, no_return ? kNoReturnRay : kFreeSpace);
  }
}

}  // namespace

void cast_rays(const KeyframeRecord& record, std::span<const PixelClass> classes, const OctreeConfig& octree,
               const SamplingConfig& sampling, Scan& scan) {
  const VoxelProjector project(record, octree.resolution_m, sampling.max_range_m);
  scan.surfaces.clear();
  if (!in_key_range(project.origin)) {
    scan.grid.reset({0, 0, 0}, {0, 0, 0});
    return;
  }
  Eigen::Vector3d lowest = project.origin;
  Eigen::Vector3d highest = project.origin;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i)
    if (project.point(i, classes[i], at)) {
      lowest = lowest.cwiseMin(at);
      highest = highest.cwiseMax(at);
    }
  scan.grid.reset(key_at(lowest), key_at(highest));
  mark_surfaces(project, classes, scan);
  if (!octree.carve_rays) return;
  carve(project, classes, false, scan);
  carve(project, classes, true, scan);
}

}  // namespace rds::mapper
