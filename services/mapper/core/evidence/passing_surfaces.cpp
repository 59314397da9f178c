// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/passing_surfaces.hpp"

#include <algorithm>

#include "services/mapper/core/segmentation/depth_surfaces.hpp"

namespace rds::mapper {
namespace {

constexpr std::ptrdiff_t kMinPixels = 20;

/// The static pixels, of no object, that show something passing.
std::vector<bool> passing_pixels(const KeyframeRecord& record, const SceneHistory& history,
                                 const MapperConfig& config, const std::vector<PixelUse>& use) {
  const VoxelProjector project(record, config.octree.resolution_m, config.sampling.max_range_m);
  const std::int64_t apart_ns = config.confirmation.apart_ns();
  std::vector<bool> passing(record.size(), false);
  VoxelRun run;
  bool is_passing = false;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const bool labelled = !record.labels.empty() && record.labels[i] != 0;
    if (labelled || use[i] != PixelUse::kStatic || !project.point(i, PixelUse::kStatic, at)) continue;
    if (const auto key = key_at(at); run.begins_with(key)) is_passing = history.is_passing(key, apart_ns);
    passing[i] = is_passing;
  }
  return passing;
}

/// Which surfaces are passing for at least that share of their pixels; the first one stands for none.
std::vector<bool> mostly_passing(const std::vector<std::uint16_t>& surface, std::size_t surfaces,
                                 const std::vector<bool>& passing, double share) {
  std::vector<std::uint32_t> all(surfaces + 1);
  std::vector<std::uint32_t> of_them(surfaces + 1);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    ++all[surface[i]];
    of_them[surface[i]] += passing[i] ? 1 : 0;
  }
  std::vector<bool> mostly(surfaces + 1, false);
  for (std::size_t s = 1; s <= surfaces; ++s) mostly[s] = of_them[s] >= share * all[s];
  return mostly;
}

}  // namespace

void leave_out_passing(const KeyframeRecord& record, const SceneHistory& history, const MapperConfig& config,
                       std::vector<PixelUse>& use) {
  if (history.movable.empty()) return;
  const auto passing = passing_pixels(record, history, config, use);
  if (std::ranges::count(passing, true) < kMinPixels) return;
  const bool known = !record.doubt.surface.empty();
  std::vector<std::uint16_t> found;
  const auto surfaces = known ? record.doubt.surfaces : find_surfaces(record, config.sampling, found);
  const auto& surface = known ? record.doubt.surface : found;
  const auto mostly = mostly_passing(surface, surfaces, passing, config.confirmation.passing_share);
  for (std::size_t i = 0; i < record.size(); ++i)
    if (use[i] == PixelUse::kStatic && mostly[surface[i]]) use[i] = PixelUse::kNone;
}

}  // namespace rds::mapper
