// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "common/geometry/pose_change.hpp"
#include "services/mapper/core/evidence/final_map.hpp"

namespace rds::mapper {

/// How a map goes from the frame that it was made in to another one: each place as the keyframe next to it.
class MapMotion {
 public:
  /// @param keyframes  at least one. @throws std::invalid_argument without one.
  explicit MapMotion(std::span<const geometry::PoseChange> keyframes);
  [[nodiscard]] geometry::Pose after_from_before(const Eigen::Vector3d& point_before) const;
  [[nodiscard]] geometry::Pose before_from_after(const Eigen::Vector3d& point_after) const;

 private:
  std::span<const geometry::PoseChange> keyframes_;
};

/// A map of a later time, and how it lies in an earlier one.
struct LaterMap {
  const FinalMap& voxels;
  MapMotion motion;
  std::span<const std::uint16_t> label_of;  // the earlier table's index of each label of the later table
};

/// Voxels that are others than in the earlier map.
struct VoxelChanges {
  std::size_t appeared = 0;  // occupied now
  std::size_t vanished = 0;  // not occupied any more
};

/// What both maps say of space, the later one having been there later.
///
/// A voxel of the earlier map's grid is what the voxel of the later map around its middle is:
///
///   L ← clamp(L_earlier + L_later)        Eq. (2) of the paper, whose sum L_later is; so what has stood for
///                                         long is gone after five misses, what is put somewhere is there
///                                         after three hits, as in the evidence of one map
///   L ← L_later                           where that is clamped: it may stand for any number of keyframes
///
/// Grids that are turned to each other do not meet: a surface of the earlier map stays where any voxel of the
/// later one that it touches is not free. Colours and votes on labels are sums.
FinalMap add_later(const FinalMap& earlier, const LaterMap& later, double voxel_m, VoxelChanges& changes);

/// Lowest corner of a voxel, and the key of the one around a point [m].
Eigen::Vector3d corner_of(const octomap::OcTreeKey& key, double voxel_m);
octomap::OcTreeKey key_around(const Eigen::Vector3d& point, double voxel_m);

}  // namespace rds::mapper
