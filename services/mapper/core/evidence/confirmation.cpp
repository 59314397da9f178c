// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/confirmation.hpp"

namespace rds::mapper {
namespace {

constexpr double kConfirmedShare = 0.7;        // of a surface's pixels
constexpr double kLargeSurface = 0.1;          // share of the picture: walls and floors fill it, people do not, ...
constexpr double kConfirmedShareOfLarge = 0.15;  // ... so that less of it suffices

struct Support {
  std::uint32_t pixels = 0;
  std::uint32_t confirmed = 0;
};

/// How many pixels each surface has, and how many of them were seen as static at another time.
std::vector<Support> support_of_surfaces(const KeyframeRecord& record, const StaticHistory& history,
                                         const MapperConfig& config) {
  const VoxelProjector project(record, config.octree.resolution_m, config.sampling.max_range_m);
  const std::int64_t apart_ns = config.confirmation.apart_ns();
  std::vector<Support> support(std::size_t{record.doubt.surfaces} + 1);
  VoxelRun run;
  bool confirmed = false;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const auto surface = record.doubt.surface[i];
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

}  // namespace

std::vector<bool> confirmed_surfaces(const KeyframeRecord& record, const StaticHistory& history,
                                     const MapperConfig& config) {
  if (record.doubt.empty()) return {};
  const auto support = support_of_surfaces(record, history, config);
  std::vector<bool> confirmed(support.size());
  for (std::size_t s = 1; s < support.size(); ++s)
    confirmed[s] = is_confirmed(support[s], record.size());
  return confirmed;
}

}  // namespace rds::mapper
