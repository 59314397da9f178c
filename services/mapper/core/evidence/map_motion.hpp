// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/pose_change.hpp"
#include "services/mapper/core/keyframe/voxel_key.hpp"

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

/// Lowest corner of a voxel, and the key of the one around a point [m].
Eigen::Vector3d corner_of(const octomap::OcTreeKey& key, double voxel_m);
octomap::OcTreeKey key_around(const Eigen::Vector3d& point, double voxel_m);

}  // namespace rds::mapper
