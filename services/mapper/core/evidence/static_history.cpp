// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/static_history.hpp"

namespace rds::mapper {

void StaticHistory::see(const KeyframeRecord& record, const MapperConfig& config) {
  const VoxelProjector project(record, config.octree.resolution_m, config.sampling.max_range_m);
  VoxelRun run;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (record.classes[i] != PixelClass::kStatic || !project.point(i, PixelClass::kStatic, at)) continue;
    if (const auto key = key_at(at); run.begins_with(key)) voxels_[packed(key)].add(record.time_ns);
  }
}

void StaticHistory::know(const octomap::OcTreeKey& key) {
  voxels_.insert_or_assign(packed(key), PlaceSightings{kBeforeAll, kAfterAll, 0, 1});
}

const PlaceSightings* StaticHistory::sightings(const octomap::OcTreeKey& key) const {
  const auto found = voxels_.find(packed(key));
  return found == voxels_.end() ? nullptr : &found->second;
}

bool StaticHistory::seen_apart(const octomap::OcTreeKey& key, std::int64_t time_ns,
                               std::int64_t apart_ns) const {
  const PlaceSightings* seen = sightings(key);
  return seen != nullptr && (seen->first_ns <= time_ns - apart_ns || seen->last_ns >= time_ns + apart_ns);
}

}  // namespace rds::mapper
