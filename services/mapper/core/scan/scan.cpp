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
std::uint32_t slot_of(const octomap::OcTreeKey& key, std::size_t pixel, const KeyframeRecord& record,
                      Scan& scan) {
  auto& block = scan.grid.block_of(key);
  const auto cell = cell_of(key);
  if ((block.flags[cell] & kSurface) == 0) {
    block.flags[cell] |= kSurface;
    block.slot[cell] = static_cast<std::uint32_t>(scan.surfaces.size());
    auto& voxel = scan.surfaces.emplace_back();
    voxel.key = key;
    voxel.beside = objects_around(record, pixel);
  }
  return block.slot[cell];
}

/// Casts a ray to a pixel's point, one per voxel in which rays end.
void cast_to(std::size_t pixel, const VoxelProjector& project, ScanFlag flag, VoxelRun& run, ScanGrid& grid) {
  Eigen::Vector3d at;
  if (!project.point(pixel, project.record.classes[pixel], at)) return;
  const auto key = key_at(at);
  if (!run.begins_with(key)) return;
  auto& flags = grid.block_of(key).flags[cell_of(key)];
  if ((flags & kRayCast) != 0) return;
  flags |= kRayCast;
  grid.cast_ray(project.origin, at, flag);
}

/// Rays to static and doubtful surfaces, to what is far, and to what is not measured.
void carve(const VoxelProjector& project, Scan& scan) {
  VoxelRun run;
  for (const SurfaceVoxel& voxel : scan.surfaces)
    if (voxel.ray_end != SurfaceVoxel::kNoPixel) cast_to(voxel.ray_end, project, kFreeSpace, run, scan.grid);
  const PixelClasses& classes = project.record.classes;
  for (const auto& [its_class, flag] :
       {std::pair(PixelClass::kFar, kFreeSpace), std::pair(PixelClass::kNoReturn, kNoReturnRay)})
    for (std::size_t i = 0; i < classes.size(); ++i)
      if (classes[i] == its_class) cast_to(i, project, flag, run, scan.grid);
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
    if ((grid.block_of(lowest).flags[cell_of(lowest)] & kDynamicPlace) != 0) continue;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          const octomap::OcTreeKey voxel(at(lowest[0] + x), at(lowest[1] + y), at(lowest[2] + z));
          grid.block_of(voxel).flags[cell_of(voxel)] |= kDynamicPlace;
        }
  }
}

void mark_dynamic_places(const VoxelProjector& project, const SamplingConfig& sampling, unsigned bits,
                         ScanGrid& grid) {
  const KeyframeRecord& record = project.record;
  const auto nearest = static_cast<float>(sampling.min_range_m);
  const auto farthest = static_cast<float>(sampling.max_range_m);
  VoxelRun run;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!is_dynamic(record, i) || record.depth_m(i) < nearest || record.depth_m(i) > farthest) continue;
    if (!project.point(i, PixelClass::kDynamic, at)) continue;
    if (const auto key = key_at(at); run.begins_with(key)) mark_around(key, bits, grid);
  }
}

/// Makes the grid cover all that the record can show, and the cubes around it.
void cover(const VoxelProjector& project, const OctreeConfig& octree, ScanGrid& grid) {
  constexpr float kLongest = VoxelProjector::kMaxObliqueness * VoxelProjector::kMaxObliqueness;
  float longest = 0;
  for (const Eigen::Vector3f& ray : *project.record.grid.rays)
    if (const float length = ray.squaredNorm(); length <= kLongest) longest = std::max(longest, length);
  const double reach = std::sqrt(double{longest}) * project.max_range_m / octree.resolution_m +
                       (2 << cube_bits(octree.resolution_m));
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(reach);
  grid.reset(key_at((project.origin - around).cwiseMax(0)),
             key_at((project.origin + around).cwiseMin(Eigen::Vector3d::Constant(65535))));
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
  const VoxelProjector project(record, octree.resolution_m, sampling.max_range_m);
  scan.surfaces.clear();
  if (!in_key_range(project.origin)) return scan.grid.reset({0, 0, 0}, {0, 0, 0});
  cover(project, octree, scan.grid);
  VoxelRun run;
  std::uint32_t slot = 0;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const PixelClass its_class = record.classes[i];
    if (its_class == PixelClass::kFar || its_class == PixelClass::kNoReturn ||
        !project.point(i, its_class, at))
      continue;
    if (const auto key = key_at(at); run.begins_with(key)) slot = slot_of(key, i, record, scan);
    SurfaceVoxel& voxel = scan.surfaces[slot];
    if (voxel.surface == 0 && !scan.surface_of_pixel.empty()) voxel.surface = scan.surface_of_pixel[i];
    add_pixel(voxel, record, i);
  }
}

void cast_rays(const KeyframeRecord& record, const OctreeConfig& octree, const SamplingConfig& sampling,
               Scan& scan) {
  const VoxelProjector project(record, octree.resolution_m, sampling.max_range_m);
  if (!in_key_range(project.origin)) return;
  mark_dynamic_places(project, sampling, cube_bits(octree.resolution_m), scan.grid);
  if (!octree.carve_rays) return;
  carve(project, scan);
  for (const SurfaceVoxel& voxel : scan.surfaces)
    if (voxel.observation() >= Observation::kUnknown) scan.grid.mark_beside(voxel.key);
}

}  // namespace rds::mapper
