// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/box.hpp"

#include <algorithm>

namespace rds::geometry {
namespace {
constexpr double kNearPlaneM = 0.05;
}

double Box2::area() const {
  return std::max(0.0, width()) * std::max(0.0, height());
}

Box2 Box2::clipped(int image_width, int image_height) const {
  const double w = image_width;
  const double h = image_height;
  return {std::clamp(x0, 0.0, w), std::clamp(y0, 0.0, h), std::clamp(x1, 0.0, w), std::clamp(y1, 0.0, h)};
}

double iou(const Box2& a, const Box2& b) {
  const double w = std::min(a.x1, b.x1) - std::max(a.x0, b.x0);
  const double h = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
  if (w <= 0 || h <= 0) return 0;
  return w * h / (a.area() + b.area() - w * h);
}

std::optional<Box2> project(const Box3& box_in_map, const Pose& camera_from_map, const CameraModel& camera) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box2 hull{kInfinity, kInfinity, -kInfinity, -kInfinity};
  bool any_in_front = false;
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d p = box_in_map.min;
    for (int axis = 0; axis < 3; ++axis)
      if (corner >> axis & 1) p[axis] = box_in_map.max[axis];
    p = camera_from_map * p;
    any_in_front |= p.z() > kNearPlaneM;
    p.z() = std::max(p.z(), kNearPlaneM);
    // A corner far outside the image would fold back under a distortion polynomial: the ideal camera bounds
    // it.
    const Eigen::Vector2d pixel = camera.project_undistorted(p);
    hull = {std::min(hull.x0, pixel.x()), std::min(hull.y0, pixel.y()), std::max(hull.x1, pixel.x()),
            std::max(hull.y1, pixel.y())};
  }
  const Box2 clipped = hull.clipped(camera.width, camera.height);
  if (!any_in_front || clipped.area() <= 0) return std::nullopt;
  return clipped;
}

}  // namespace rds::geometry
