// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/oriented_box.hpp"

#include <cmath>

namespace rds::geometry {
namespace {

constexpr double kNearestCenterM = 0.05;
constexpr double kDistortionBound = 0.5;  // of the picture's size, beyond its edges

/// Pixel of a point with z > 0. Far outside the picture, where a distortion polynomial may fold back, the
/// ideal camera bounds it.
Eigen::Vector2d pixel_of(const Eigen::Vector3d& point, const CameraModel& camera) {
  const Eigen::Vector2d ideal = camera.project_undistorted(point);
  const Eigen::Array2d size(camera.width, camera.height);
  const bool near = (ideal.array() >= -kDistortionBound * size).all() &&
                    (ideal.array() <= (1 + kDistortionBound) * size).all();
  return near ? camera.project(point) : ideal;
}

/// Half extents, across and down, of the box turned to face a camera from which it stands rotated.
Eigen::Vector2d facing_half_extents(const Eigen::Vector3d& size, const Eigen::Matrix3d& rotation) {
  // Twist about the optical axis of the swing-twist decomposition.
  const double roll = std::atan2(rotation(1, 0) - rotation(0, 1), rotation(0, 0) + rotation(1, 1));
  const double c = std::cos(roll);
  const double s = std::sin(roll);
  return {std::hypot(size.x() * c, size.y() * s) / 2, std::hypot(size.x() * s, size.y() * c) / 2};
}

}  // namespace

std::array<Eigen::Vector3d, 8> OrientedBox::corners() const {
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d sign((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1);
    corners[i] = map_from_box * (sign.cwiseProduct(size) / 2).eval();
  }
  return corners;
}

Box3 OrientedBox::axis_aligned_hull() const {
  const Eigen::Vector3d half = map_from_box.linear().cwiseAbs() * size / 2;
  return {center() - half, center() + half};
}

bool OrientedBox::contains(const Eigen::Vector3d& point_in_map) const {
  const Eigen::Vector3d offset = map_from_box.linear().transpose() * (point_in_map - center());
  return (offset.cwiseAbs().array() <= size.array() / 2).all();
}

bool is_valid(const OrientedBox& box) {
  return is_finite(box.map_from_box) && box.size.allFinite() && (box.size.array() > 0).all();
}

std::optional<Box2> whole_image_box(const OrientedBox& box, const Pose& camera_from_map,
                                    const CameraModel& camera) {
  const Pose camera_from_box = camera_from_map * box.map_from_box;
  const Eigen::Vector3d center = camera_from_box.translation();
  if (!is_finite(camera_from_box) || !(center.z() > kNearestCenterM)) return std::nullopt;
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  half.head<2>() = facing_half_extents(box.size, camera_from_box.linear());
  const Eigen::Vector2d top_left = pixel_of(center - half, camera);
  const Eigen::Vector2d bottom_right = pixel_of(center + half, camera);
  return Box2{top_left.x(), top_left.y(), bottom_right.x(), bottom_right.y()};
}

std::optional<Box2> image_box(const OrientedBox& box, const Pose& camera_from_map,
                              const CameraModel& camera) {
  const auto whole = whole_image_box(box, camera_from_map, camera);
  if (!whole) return std::nullopt;
  const Box2 visible = whole->clipped(camera.width, camera.height);
  if (!(visible.area() > 0)) return std::nullopt;
  return visible;
}

}  // namespace rds::geometry
