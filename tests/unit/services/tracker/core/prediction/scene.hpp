// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "services/tracker/core/prediction/tracked_object.hpp"
#include "services/transformer/core/box_transform.hpp"

namespace rds::tracker::prediction::scene {

inline geometry::CameraModel camera() {
  geometry::CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 500;
  camera.cx = 320;
  camera.cy = 240;
  return camera;
}

inline std::int64_t nanoseconds(double seconds) {
  return std::llround(seconds * 1e9);
}

/// What a detector and the transformer make of a person (0.5 × 0.9 m as seen) at a place in the map.
inline std::optional<ObjectObservation> see_person(const Eigen::Vector3d& place,
                                                   const geometry::Pose& map_from_camera,
                                                   const std::string& label = "person") {
  const Eigen::Vector3d p = map_from_camera.inverse() * place;
  if (p.z() < 0.3) return std::nullopt;
  const Eigen::Vector3d half(0.25, 0.45, 0);
  const Eigen::Vector2d top_left = camera().project(p - half);
  const Eigen::Vector2d bottom_right = camera().project(p + half);
  const auto box = transformer::box_in_map({top_left.x(), top_left.y(), bottom_right.x(), bottom_right.y()},
                                           p.z(), label, map_from_camera, camera());
  if (!box) return std::nullopt;
  return ObjectObservation{*box, label, 0.9F};
}

}  // namespace rds::tracker::prediction::scene
