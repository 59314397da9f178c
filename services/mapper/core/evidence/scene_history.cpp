// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/scene_history.hpp"

namespace rds::mapper {

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
