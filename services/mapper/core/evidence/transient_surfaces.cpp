// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/transient_surfaces.hpp"

#include <algorithm>

#include "services/mapper/core/segmentation/depth_surfaces.hpp"

namespace rds::mapper {
namespace {

constexpr std::ptrdiff_t kMinPixels = 20;

/// The static pixels without a label whose voxels are transient.
std::vector<bool> pixels_in_transient_voxels(const KeyframeRecord& record, const SceneHistory& history,
                                             const MapperConfig& config, const PixelClasses& classes) {
  const VoxelProjector project(record, config.octree.resolution_m, config.sampling.max_range_m);
  const std::int64_t apart_ns = config.confirmation.apart_ns();
  std::vector<bool> transient(record.size(), false);
  VoxelRun run;
  bool is_transient = false;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const bool labelled = !record.labels.empty() && record.labels[i] != 0;
    if (labelled || classes[i] != PixelClass::kStatic || !project.point(i, PixelClass::kStatic, at)) continue;
    if (const auto key = key_at(at); run.begins_with(key)) is_transient = history.is_transient(key, apart_ns);
    transient[i] = is_transient;
  }
  return transient;
}

/// Which surfaces are transient for at least that share of their pixels; index 0 stands for no surface.
std::vector<bool> mostly_transient(const std::vector<std::uint16_t>& surface, std::size_t surfaces,
                                   const std::vector<bool>& transient, double share) {
  std::vector<std::uint32_t> all(surfaces + 1);
  std::vector<std::uint32_t> of_transient(surfaces + 1);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    ++all[surface[i]];
    of_transient[surface[i]] += transient[i] ? 1 : 0;
  }
  std::vector<bool> mostly(surfaces + 1, false);
  for (std::size_t s = 1; s <= surfaces; ++s) mostly[s] = of_transient[s] >= share * all[s];
  return mostly;
}

}  // namespace

std::vector<bool> transient_pixels(const KeyframeRecord& record, const SceneHistory& history,
                                   const MapperConfig& config, const PixelClasses& classes) {
  if (history.dynamics.empty()) return {};
  const auto transient = pixels_in_transient_voxels(record, history, config, classes);
  if (std::ranges::count(transient, true) < kMinPixels) return {};
  const bool known = !record.doubt.empty();
  std::vector<std::uint16_t> found;
  const auto surfaces = known ? record.doubt.surfaces : find_surfaces(record, found);
  const auto& surface = known ? record.doubt.surface : found;
  const auto mostly = mostly_transient(surface, surfaces, transient, config.confirmation.transient_share);
  std::vector<bool> pixels(record.size());
  for (std::size_t i = 0; i < record.size(); ++i)
    pixels[i] = classes[i] == PixelClass::kStatic && mostly[surface[i]];
  return pixels;
}

}  // namespace rds::mapper
