// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unordered_set>

#include "services/mapper/core/mapper_config.hpp"
#include "services/mapper/core/voxel_projector.hpp"

namespace rds::mapper {

/// Where boxes or the tracker have known of something movable, in cubes of about 10 cm: somebody who stands
/// sways.
class MovableHistory {
 public:
  explicit MovableHistory(double resolution_m);

  /// The movable pixels of a keyframe, where its pose puts them.
  void see(const KeyframeRecord& record, const MapperConfig& config);

  /// True if something movable was there, or half a cube beside it.
  [[nodiscard]] bool was_there(const octomap::OcTreeKey& key) const {
    return !cubes_.empty() && cubes_.contains(cube(key));
  }

 private:
  [[nodiscard]] std::uint64_t cube(const octomap::OcTreeKey& key) const {
    return packed({static_cast<std::uint16_t>(key[0] >> cube_bits_),
                   static_cast<std::uint16_t>(key[1] >> cube_bits_),
                   static_cast<std::uint16_t>(key[2] >> cube_bits_)});
  }
  void see_around(const octomap::OcTreeKey& key);

  int cube_bits_;  // voxels of a cube's side, log2
  std::unordered_set<std::uint64_t> cubes_;
};

}  // namespace rds::mapper
