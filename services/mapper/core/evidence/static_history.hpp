// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unordered_map>

#include "services/mapper/core/config/mapper_config.hpp"
#include "services/mapper/core/evidence/place_sightings.hpp"
#include "services/mapper/core/keyframe/voxel_projector.hpp"

namespace rds::mapper {

/// When and how often static pixels were seen in a voxel.
class StaticHistory {
 public:
  /// Adds the static pixels of a keyframe, where its pose puts them.
  void see(const KeyframeRecord& record, const MapperConfig& config);
  /// Adds a voxel of a saved map: it counts as seen at all times.
  void know(const octomap::OcTreeKey& key);

  /// True if it was seen at least so long before or after this time.
  [[nodiscard]] bool seen_apart(const octomap::OcTreeKey& key, std::int64_t time_ns,
                                std::int64_t apart_ns) const;

  /// Nullptr if there are none.
  [[nodiscard]] const PlaceSightings* sightings(const octomap::OcTreeKey& key) const;

 private:
  std::unordered_map<std::uint64_t, PlaceSightings> voxels_;  // by key only: their order means nothing
};

}  // namespace rds::mapper
