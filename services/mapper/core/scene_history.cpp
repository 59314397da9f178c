// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/scene_history.hpp"

namespace rds::mapper {
namespace {

constexpr std::uint32_t kMostly = 2;  // static sightings for each movable one: a detector misses less

}  // namespace

bool SceneHistory::is_suspect(const octomap::OcTreeKey& key, std::int64_t stamp_ns) const {
  const PlaceSightings* there = movable.sightings(key);
  if (there == nullptr) return false;
  const PlaceSightings* seen = surfaces.sightings(key);
  return seen == nullptr || (seen->last_ns <= stamp_ns && seen->keyframes < kMostly * there->keyframes);
}

}  // namespace rds::mapper
