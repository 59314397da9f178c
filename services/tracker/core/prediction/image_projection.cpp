// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/image_projection.hpp"

#include <algorithm>
#include <cmath>

namespace rds::tracker::prediction {
namespace {

constexpr double kNearestCenterM = 0.05;
constexpr double kDistortionBound = 0.5;  // of the picture's size, beyond its edges

/// Pixel of a point with z > 0. Far outside the picture, where a distortion polynomial may fold back, the
/// ideal camera bounds it.
Eigen::Vector2d pixel_of(const Eigen::Vector3d& point, const geometry::CameraModel& camera) {
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

std::optional<geometry::Box2> whole_image_box(const geometry::OrientedBox& box,
                                              const geometry::Pose& camera_from_map,
                                              const geometry::CameraModel& camera) {
  const geometry::Pose camera_from_box = camera_from_map * box.map_from_box;
  const Eigen::Vector3d center = camera_from_box.translation();
  if (!geometry::is_finite(camera_from_box) || !(center.z() > kNearestCenterM)) return std::nullopt;
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  half.head<2>() = facing_half_extents(box.size, camera_from_box.linear());
  const Eigen::Vector2d top_left = pixel_of(center - half, camera);
  const Eigen::Vector2d bottom_right = pixel_of(center + half, camera);
  return geometry::Box2{top_left.x(), top_left.y(), bottom_right.x(), bottom_right.y()};
}

std::optional<geometry::Box2> image_box(const geometry::OrientedBox& box,
                                        const geometry::Pose& camera_from_map,
                                        const geometry::CameraModel& camera) {
  const auto whole = whole_image_box(box, camera_from_map, camera);
  if (!whole) return std::nullopt;
  const geometry::Box2 visible = whole->clipped(camera.width, camera.height);
  if (!(visible.area() > 0)) return std::nullopt;
  return visible;
}

CutSides cut_sides(const geometry::OrientedBox& box, const geometry::Pose& camera_from_map,
                   const geometry::CameraModel& camera, double border_px) {
  const auto seen = image_box(box, camera_from_map, camera);
  if (!seen) return {};
  return {seen->x0 <= border_px, seen->y0 <= border_px, seen->x1 >= camera.width - border_px,
          seen->y1 >= camera.height - border_px};
}

std::optional<PredictedBox> to_image(const geometry::OrientedBox& box, const geometry::Pose& camera_from_map,
                                     const geometry::CameraModel& camera, const RegionConfig& config) {
  const auto visible = image_box(box, camera_from_map, camera);
  if (!visible) return std::nullopt;
  const double m = config.margin_px;
  const geometry::Box2 wide{visible->x0 - m, visible->y0 - m, visible->x1 + m, visible->y1 + m};
  const double depth = (camera_from_map * box.center()).z();
  const double reach = box.size.z() / 2 + config.margin_depth_m;
  return PredictedBox{*visible,
                      {wide.clipped(camera.width, camera.height),
                       static_cast<float>(std::max(0.0, depth - reach)), static_cast<float>(depth + reach)}};
}

std::optional<PredictedBox> to_image(const PredictedObject& object, const geometry::Pose& camera_from_map,
                                     const geometry::CameraModel& camera, const RegionConfig& config) {
  return to_image(object.box, camera_from_map, camera, config);
}

}  // namespace rds::tracker::prediction
