// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/scene_history.hpp"

#include <cmath>

namespace rds::mapper {
namespace {
constexpr double kCubeM = 0.1;
}

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

DynamicHistory::DynamicHistory(double resolution_m)
    : cube_bits_(std::max(0, static_cast<int>(std::lround(std::log2(kCubeM / resolution_m))))) {}

void DynamicHistory::see(const KeyframeRecord& record, const MapperConfig& config) {
  const VoxelProjector project(record, config.octree.resolution_m, config.sampling.max_range_m);
  const auto nearest = static_cast<float>(config.sampling.min_range_m);
  const auto farthest = static_cast<float>(config.sampling.max_range_m);
  VoxelRun run;
  Eigen::Vector3d at;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!is_dynamic(record, i) || record.depth_m(i) < nearest || record.depth_m(i) > farthest) continue;
    if (!project.point(i, PixelClass::kDynamic, at)) continue;
    if (const auto key = key_at(at); run.begins_with(key)) see_around(key, record.time_ns);
  }
}

void DynamicHistory::see_around(const octomap::OcTreeKey& key, std::int64_t time_ns) {
  const int half = 1 << cube_bits_ >> 1;
  for (int corner = 0; corner < 8; ++corner) {
    const auto shifted = [&](unsigned axis) {
      return static_cast<std::uint16_t>(key[axis] + ((corner >> axis & 1) != 0 ? half : -half));
    };
    cubes_[cube({shifted(0), shifted(1), shifted(2)})].add(time_ns);
  }
}

const PlaceSightings* DynamicHistory::sightings(const octomap::OcTreeKey& key) const {
  if (cubes_.empty()) return nullptr;
  const auto found = cubes_.find(cube(key));
  return found == cubes_.end() ? nullptr : &found->second;
}

bool SceneHistory::is_ghost(const octomap::OcTreeKey& key, std::int64_t time_ns) const {
  const PlaceSightings* dynamic = dynamics.sightings(key);
  if (dynamic == nullptr) return false;
  const PlaceSightings* as_static = statics.sightings(key);
  return as_static == nullptr || (as_static->last_ns <= time_ns && as_static->keyframes < dynamic->keyframes);
}

bool SceneHistory::is_transient(const octomap::OcTreeKey& key, std::int64_t apart_ns) const {
  const PlaceSightings* dynamic = dynamics.sightings(key);
  if (dynamic == nullptr) return false;
  const PlaceSightings* as_static = statics.sightings(key);
  return as_static == nullptr ||
         (as_static->first_ns > dynamic->first_ns - apart_ns &&
          as_static->last_ns < dynamic->last_ns + apart_ns && as_static->keyframes < dynamic->keyframes);
}

}  // namespace rds::mapper
