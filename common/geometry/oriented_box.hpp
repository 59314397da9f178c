// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "common/geometry/box.hpp"
#include "common/geometry/camera_model.hpp"
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

/// Image box of a box that was made from a detection.
///
/// The rectangle size.x × size.y through the box's centre is turned to face the camera; its top-left and
/// bottom-right corners (the paper's P_wp1 and P_wp2) are projected with distortion. At the pose of the
/// detection this is the detection's box, whatever the thickness: the hull of the eight corners would be
/// wider. A camera that has rolled about its axis by θ since sees the half extents √((w cos θ)² + (h sin θ)²)
/// and √((w sin θ)² + (h cos θ)²): those of the ellipse in the rectangle, because people do not fill its
/// corners.
///
/// @return with the parts outside the picture; nullopt if the centre is not in front of the camera.
/// Source: paper §IV-B, eq. (1), P_c = T_cw · P_wp.
std::optional<Box2> whole_image_box(const OrientedBox& box, const Pose& camera_from_map,
                                    const CameraModel& camera);

/// whole_image_box() clipped to the picture; nullopt if nothing of it is there.
std::optional<Box2> image_box(const OrientedBox& box, const Pose& camera_from_map, const CameraModel& camera);

}  // namespace rds::geometry
