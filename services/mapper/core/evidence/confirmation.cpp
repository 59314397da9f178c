// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/confirmation.hpp"

#include <algorithm>
#include <cmath>

#include "services/mapper/core/evidence/near_points.hpp"
#include "services/mapper/core/segmentation/depth_surfaces.hpp"

namespace rds::mapper {
namespace {

/// Points of what boxes and the tracker know as movable.
std::vector<Eigen::Vector3f> movable_points(const KeyframeRecord& record, const SamplingConfig& config) {
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!is_movable(record, i)) continue;
    const float depth = record.depth_m(i);
    if (depth >= static_cast<float>(config.min_range_m) && depth <= static_cast<float>(config.max_range_m))
      points.push_back(record.point_in_camera(i));
  }
  return points;
}

struct Support {
  std::uint32_t pixels = 0;
  std::uint32_t confirmed = 0;
};

/// How much of each surface was seen at another time, too.
std::vector<Support> support_of_surfaces(const KeyframeRecord& record, const SurfaceHistory& history,
                                         const MapperConfig& config) {
  const VoxelProjector project(record, config.octree.resolution_m, config.sampling.max_range_m);
  const std::int64_t apart_ns = config.confirmation.apart_ns();
  std::vector<Support> support(std::size_t{record.doubt.surfaces} + 1);
  VoxelRun run;
  bool confirmed = false;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const auto surface = record.doubt.surface[i];
    if (surface == 0 || !project.point(i, PixelUse::kStatic, at)) continue;
    if (const auto key = key_at(at); run.begins_with(key))
      confirmed = history.seen_apart(key, record.time_ns, apart_ns);
    ++support[surface].pixels;
    support[surface].confirmed += confirmed ? 1 : 0;
  }
  return support;
}

bool stands(const Support& support, std::size_t picture, const ConfirmationConfig& config) {
  const bool large = support.pixels >= config.large * static_cast<double>(picture);
  const double needed = large ? config.share_of_large : config.share;
  return support.pixels > 0 && support.confirmed >= needed * support.pixels;
}

}  // namespace

void mark_doubtful(KeyframeRecord& record, const MapperConfig& config) {
  record.doubt = {};
  if (!(config.confirmation.radius_m > 0)) return;
  const auto movable = movable_points(record, config.sampling);
  if (movable.empty()) return;
  const NearPoints near(movable, static_cast<float>(config.confirmation.radius_m));
  auto& doubtful = record.doubt.near_movable;
  doubtful.assign(record.size(), false);
  bool any = false;
  const bool knows_background = !record.background.empty();
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (knows_background && record.background[i]) continue;
    doubtful[i] = record.use[i] == PixelUse::kUnsure ||
                  (record.use[i] == PixelUse::kStatic && near.contains(record.point_in_camera(i)));
    any = any || doubtful[i];
  }
  if (any)
    record.doubt.surfaces = find_surfaces(record, config.sampling, record.doubt.surface);
  else
    record.doubt = {};
}

std::vector<PixelUse> confirmed_use(const KeyframeRecord& record, const SurfaceHistory& history,
                                    const MapperConfig& config) {
  std::vector<PixelUse> use = record.use;
  if (record.doubt.surface.empty()) {
    std::ranges::replace(use, PixelUse::kUnsure, PixelUse::kNone);
    return use;
  }
  const auto support = support_of_surfaces(record, history, config);
  std::vector<bool> standing(support.size());
  for (std::size_t s = 1; s < support.size(); ++s)
    standing[s] = stands(support[s], record.size(), config.confirmation);
  for (std::size_t i = 0; i < record.size(); ++i)
    if (record.doubt.near_movable[i])
      use[i] = standing[record.doubt.surface[i]] ? PixelUse::kStatic : PixelUse::kNone;
  return use;
}

}  // namespace rds::mapper
