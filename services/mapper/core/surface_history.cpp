// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/surface_history.hpp"

#include <algorithm>
#include <limits>

namespace rds::mapper {

void SurfaceHistory::see(const KeyframeRecord& record, const MapperConfig& config) {
  const VoxelProjector project(record, config.octree.resolution_m, config.sampling.max_range_m);
  const std::int64_t now = record.stamp_ns;
  std::uint64_t last = 0;  // neighbours mostly fall into one voxel; no key is 0
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (record.use[i] != PixelUse::kStatic || !project.point(i, PixelUse::kStatic, at)) continue;
    const std::uint64_t key = packed(key_at(at));
    if (key == last) continue;
    last = key;
    Span& span = spans_.try_emplace(key, Span{now, now}).first->second;
    span = {std::min(span.first_ns, now), std::max(span.last_ns, now)};
  }
}

void SurfaceHistory::know(const octomap::OcTreeKey& key) {
  using Limits = std::numeric_limits<std::int64_t>;
  spans_.insert_or_assign(packed(key), Span{Limits::min() / 2, Limits::max() / 2});
}

bool SurfaceHistory::seen_apart(const octomap::OcTreeKey& key, std::int64_t stamp_ns,
                                std::int64_t apart_ns) const {
  const auto found = spans_.find(packed(key));
  if (found == spans_.end()) return false;
  return found->second.first_ns <= stamp_ns - apart_ns || found->second.last_ns >= stamp_ns + apart_ns;
}

}  // namespace rds::mapper
