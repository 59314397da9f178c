// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/scene_history.hpp"

namespace rds::mapper {
bool SceneHistory::is_suspect(const octomap::OcTreeKey& key, std::int64_t time_ns) const {
  const PlaceSightings* there = movable.sightings(key);
  if (there == nullptr) return false;
  const PlaceSightings* seen = surfaces.sightings(key);
  return seen == nullptr || (seen->last_ns <= time_ns && seen->keyframes < there->keyframes);
}

bool SceneHistory::is_passing(const octomap::OcTreeKey& key, std::int64_t apart_ns) const {
  const PlaceSightings* there = movable.sightings(key);
  if (there == nullptr) return false;
  const PlaceSightings* seen = surfaces.sightings(key);
  return seen == nullptr || (seen->first_ns > there->first_ns - apart_ns &&
                             seen->last_ns < there->last_ns + apart_ns && seen->keyframes < there->keyframes);
}

}  // namespace rds::mapper
