// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rds::mapper {
namespace {

constexpr double kKeyOffset = 32768;  // key of coordinate 0
constexpr double kLowestKey = 8;
constexpr double kHighestKey = 65536 - 8;
constexpr float kMaxObliqueness =
    2;  // a point farther than this × its depth is at the edge of a fisheye: left out

octomap::OcTreeKey key_at(const Eigen::Vector3d& p) {
  return {static_cast<std::uint16_t>(p.x()), static_cast<std::uint16_t>(p.y()),
          static_cast<std::uint16_t>(p.z())};
}

bool in_key_range(const Eigen::Vector3d& p) {
  return p.allFinite() && p.minCoeff() >= kLowestKey && p.maxCoeff() < kHighestKey;
}

/// Points in key units; points beyond the range are pulled in along their ray.
struct Projector {
  Projector(const KeyframeRecord& keyframe, const OctreeConfig& octree, const SamplingConfig& sampling)
      : record(keyframe),
        rotation(keyframe.map_from_camera.linear() / octree.resolution_m),
        origin(keyframe.map_from_camera.translation() / octree.resolution_m +
               Eigen::Vector3d::Constant(kKeyOffset)),
        max_range_m(static_cast<float>(sampling.max_range_m)) {}

  [[nodiscard]] bool point(std::size_t pixel, Eigen::Vector3d& at) const {
    const auto use = record.use[pixel];
    if (use == PixelUse::kNone) return false;
    const Eigen::Vector3f& ray = (*record.rays)[pixel];
    if (!(ray.squaredNorm() <= kMaxObliqueness * kMaxObliqueness)) return false;
    const float depth = use == PixelUse::kBeyond ? max_range_m : record.depth_m(pixel);
    at = rotation * (ray * depth).cast<double>() + origin;
    return in_key_range(at);
  }

  const KeyframeRecord& record;
  Eigen::Matrix3d rotation;
  Eigen::Vector3d origin;
  float max_range_m;
};

void add_pixel(SurfaceVoxel& voxel, const KeyframeRecord& record, std::size_t pixel) {
  if (record.use[pixel] == PixelUse::kMovable) {
    ++voxel.movable_pixels;
    return;
  }
  ++voxel.static_pixels;
  for (std::size_t c = 0; c < 3; ++c) voxel.rgb_sum[c] += record.rgb[3 * pixel + c];
  const std::uint16_t label = record.labels.empty() ? std::uint16_t{0} : record.labels[pixel];
  if (voxel.label_balance == 0) voxel.label = label;
  voxel.label_balance = voxel.label == label ? voxel.label_balance + 1 : voxel.label_balance - 1;
}

void mark_surfaces(const Projector& project, Scan& scan) {
  const auto& record = project.record;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (record.use[i] == PixelUse::kBeyond || !project.point(i, at)) continue;
    const auto key = key_at(at);
    auto& block = scan.grid.block_of(key);
    const auto cell = ScanGrid::cell_of(key);
    if ((block.flags[cell] & kSurface) == 0) {
      block.flags[cell] |= kSurface;
      block.slot[cell] = static_cast<std::uint32_t>(scan.surfaces.size());
      scan.surfaces.emplace_back();
    }
    add_pixel(scan.surfaces[block.slot[cell]], record, i);
  }
}

/// One ray per voxel in which a ray ends, to the first static pixel in it.
void carve(const Projector& project, Scan& scan) {
  const auto& record = project.record;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (record.use[i] == PixelUse::kMovable || !project.point(i, at)) continue;
    const auto key = key_at(at);
    auto& flags = scan.grid.block_of(key).flags[ScanGrid::cell_of(key)];
    if ((flags & kRayCast) != 0) continue;
    flags |= kRayCast;
    scan.grid.cast_ray(project.origin, at);
  }
}

}  // namespace

void make_scan(const KeyframeRecord& record, const OctreeConfig& octree, const SamplingConfig& sampling,
               Scan& scan) {
  const Projector project(record, octree, sampling);
  scan.surfaces.clear();
  if (!in_key_range(project.origin)) {
    scan.grid.reset({0, 0, 0}, {0, 0, 0});
    return;
  }
  Eigen::Vector3d lowest = project.origin;
  Eigen::Vector3d highest = project.origin;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i)
    if (project.point(i, at)) {
      lowest = lowest.cwiseMin(at);
      highest = highest.cwiseMax(at);
    }
  scan.grid.reset(key_at(lowest), key_at(highest));
  mark_surfaces(project, scan);
  if (octree.carve_rays) carve(project, scan);
}

}  // namespace rds::mapper
