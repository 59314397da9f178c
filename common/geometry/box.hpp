// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <Eigen/Core>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/pose.hpp"

namespace rds::geometry {

/// Axis-aligned image box [px], x0 ≤ x1, y0 ≤ y1; x1 and y1 are exclusive edges.
struct Box2 {
  double x0 = 0;
  double y0 = 0;
  double x1 = 0;
  double y1 = 0;

  [[nodiscard]] double width() const { return x1 - x0; }
  [[nodiscard]] double height() const { return y1 - y0; }
  [[nodiscard]] double area() const;
  [[nodiscard]] bool contains(double x, double y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  [[nodiscard]] Box2 clipped(int image_width, int image_height) const;
  bool operator==(const Box2&) const = default;
};

/// Intersection over union; 0 for boxes without area.
double iou(const Box2& a, const Box2& b);

/// Axis-aligned box in a 3-D frame [m].
struct Box3 {
  Eigen::Vector3d min = Eigen::Vector3d::Zero();
  Eigen::Vector3d max = Eigen::Vector3d::Zero();

  [[nodiscard]] Eigen::Vector3d center() const { return (min + max) / 2; }
  [[nodiscard]] Eigen::Vector3d size() const { return max - min; }
  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const {
    return (p.array() >= min.array()).all() && (p.array() <= max.array()).all();
  }
};

/// Smallest image box around the eight corners of a 3-D box, clipped to the image.
///
/// @return nullopt if nothing of it is in front of the camera (z > 0.05 m) or inside the image.
std::optional<Box2> project(const Box3& box_in_map, const Pose& camera_from_map, const CameraModel& camera);

}  // namespace rds::geometry
