// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unordered_map>

#include "services/mapper/core/config/mapper_config.hpp"
#include "services/mapper/core/evidence/place_sightings.hpp"
#include "services/mapper/core/keyframe/voxel_projector.hpp"

namespace rds::mapper {

/// When and how often boxes or the tracker have told of something dynamic in a place, in cubes of about 10
/// cm: a standing person moves by less.
class DynamicHistory {
 public:
  explicit DynamicHistory(double resolution_m);

  /// Adds the dynamic pixels of a keyframe, where its pose puts them.
  void see(const KeyframeRecord& record, const MapperConfig& config);

  [[nodiscard]] bool empty() const { return cubes_.empty(); }
  /// In the voxel's cube or half a cube beside it; nullptr if there are none.
  [[nodiscard]] const PlaceSightings* sightings(const octomap::OcTreeKey& key) const;

 private:
  [[nodiscard]] std::uint64_t cube(const octomap::OcTreeKey& key) const {
    return packed({static_cast<std::uint16_t>(key[0] >> cube_bits_),
                   static_cast<std::uint16_t>(key[1] >> cube_bits_),
                   static_cast<std::uint16_t>(key[2] >> cube_bits_)});
  }
  void see_around(const octomap::OcTreeKey& key, std::int64_t time_ns);

  int cube_bits_;                                            // voxels of a cube's side, log2
  std::unordered_map<std::uint64_t, PlaceSightings> cubes_;  // by key only: their order means nothing
};

}  // namespace rds::mapper
