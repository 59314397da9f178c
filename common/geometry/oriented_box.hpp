// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <Eigen/Core>

#include "common/geometry/box.hpp"
#include "common/geometry/pose.hpp"

namespace rds::geometry {

/// Box in the map with an orientation of its own, as vision_msgs/BoundingBox3D carries it.
///
/// A box made from a detection is aligned with the camera that saw it (x right, y down, z along the optical
/// axis), so that the rectangle size.x × size.y through its centre is the detection's image box.
struct OrientedBox {
  Pose map_from_box = Pose::Identity();            // its translation is the centre [m]
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  // full edge lengths along the box's axes [m]

  [[nodiscard]] Eigen::Vector3d center() const { return map_from_box.translation(); }
  [[nodiscard]] std::array<Eigen::Vector3d, 8> corners() const;
  /// Smallest box aligned with the map's axes that contains this one.
  [[nodiscard]] Box3 axis_aligned_hull() const;
  [[nodiscard]] bool contains(const Eigen::Vector3d& point_in_map) const;
};

/// Finite everywhere, edges > 0.
bool is_valid(const OrientedBox& box);

}  // namespace rds::geometry
