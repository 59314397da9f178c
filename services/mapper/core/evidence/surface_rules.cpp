// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/surface_rules.hpp"

#include <algorithm>

#include "services/mapper/core/segmentation/depth_surfaces.hpp"

namespace rds::mapper {
namespace {

constexpr double kConfirmedShare = 0.7;  // of a surface's pixels
constexpr double kLargeSurface = 0.1;    // share of the picture: walls and floors fill it, people do not, ...
constexpr double kConfirmedShareOfLarge = 0.15;  // ... so that less of it suffices
constexpr std::ptrdiff_t kMinTransientPixels = 20;

struct Support {
  std::uint32_t pixels = 0;
  std::uint32_t confirmed = 0;
};

/// How many pixels each surface has, and how many of them were seen as static at another time.
std::vector<Support> support_of_surfaces(const KeyframeRecord& record, const StaticHistory& history,
                                         const MapperConfig& config) {
  const VoxelProjector project(record, config.octree.resolution_m, config.sampling.max_range_m);
  const std::int64_t apart_ns = config.confirmation.apart_ns();
  std::vector<Support> support(std::size_t{record.unconfirmed.surfaces} + 1);
  VoxelRun run;
  bool confirmed = false;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const auto surface = record.unconfirmed.surface[i];
    if (surface == 0 || !project.point(i, PixelClass::kStatic, at)) continue;
    if (const auto key = key_at(at); run.begins_with(key))
      confirmed = history.seen_apart(key, record.time_ns, apart_ns);
    ++support[surface].pixels;
    support[surface].confirmed += confirmed ? 1 : 0;
  }
  return support;
}

bool is_confirmed(const Support& support, std::size_t picture) {
  const bool large = support.pixels >= kLargeSurface * static_cast<double>(picture);
  const double needed = large ? kConfirmedShareOfLarge : kConfirmedShare;
  return support.pixels > 0 && support.confirmed >= needed * support.pixels;
}

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
    const bool labelled = !record.objects.labels.empty() && record.objects.labels[i] != 0;
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

std::vector<bool> confirmed_surfaces(const KeyframeRecord& record, const StaticHistory& history,
                                     const MapperConfig& config) {
  if (record.unconfirmed.empty()) return {};
  const auto support = support_of_surfaces(record, history, config);
  std::vector<bool> confirmed(support.size());
  for (std::size_t s = 1; s < support.size(); ++s) confirmed[s] = is_confirmed(support[s], record.size());
  return confirmed;
}

std::vector<bool> transient_pixels(const KeyframeRecord& record, const SceneHistory& history,
                                   const MapperConfig& config, const PixelClasses& classes) {
  if (history.dynamics.empty()) return {};
  const auto transient = pixels_in_transient_voxels(record, history, config, classes);
  if (std::ranges::count(transient, true) < kMinTransientPixels) return {};
  const bool known = !record.unconfirmed.empty();
  std::vector<std::uint16_t> found;
  const auto surfaces = known ? record.unconfirmed.surfaces : find_surfaces(record, found);
  const auto& surface = known ? record.unconfirmed.surface : found;
  const auto mostly = mostly_transient(surface, surfaces, transient, config.confirmation.transient_share);
  std::vector<bool> pixels(record.size());
  for (std::size_t i = 0; i < record.size(); ++i)
    pixels[i] = classes[i] == PixelClass::kStatic && mostly[surface[i]];
  return pixels;
}

}  // namespace rds::mapper
