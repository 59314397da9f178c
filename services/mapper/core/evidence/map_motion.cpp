// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/map_motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rds::mapper {
namespace {

using geometry::Pose;
using geometry::PoseChange;
using octomap::OcTreeKey;

constexpr double kOriginKey = 32768;  // of coordinate 0

/// @param place  of a change, its camera before or after.
template <class Place>
const PoseChange& nearest(std::span<const PoseChange> changes, const Eigen::Vector3d& point, Place place) {
  return *std::ranges::min_element(changes, {}, [&](const PoseChange& change) {
    return ((change.*place).translation() - point).squaredNorm();
  });
}

}  // namespace

MapMotion::MapMotion(std::span<const PoseChange> keyframes) : keyframes_(keyframes) {
  if (keyframes.empty()) throw std::invalid_argument("MapMotion: a map that no keyframe moves");
}

Pose MapMotion::after_from_before(const Eigen::Vector3d& point_before) const {
  return nearest(keyframes_, point_before, &PoseChange::before_from_camera).after_from_before();
}

Pose MapMotion::before_from_after(const Eigen::Vector3d& point_after) const {
  return nearest(keyframes_, point_after, &PoseChange::after_from_camera).after_from_before().inverse();
}

Eigen::Vector3d corner_of(const OcTreeKey& key, double voxel_m) {
  return voxel_m * (Eigen::Vector3d(key[0], key[1], key[2]) - Eigen::Vector3d::Constant(kOriginKey));
}

OcTreeKey key_around(const Eigen::Vector3d& point, double voxel_m) {
  const auto along = [&](int axis) {
    const double key = std::floor(point[axis] / voxel_m) + kOriginKey;
    return static_cast<std::uint16_t>(std::clamp(key, 0.0, 2 * kOriginKey - 1));
  };
  return {along(0), along(1), along(2)};
}

}  // namespace rds::mapper
