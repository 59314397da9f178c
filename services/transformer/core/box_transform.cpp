// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/core/box_transform.hpp"

#include <cmath>

namespace rds::transformer {
namespace {

constexpr double kSmallestSidePx = 1;

bool is_finite(const geometry::Box2& box) {
  return std::isfinite(box.x0) && std::isfinite(box.y0) && std::isfinite(box.x1) && std::isfinite(box.y1);
}

}  // namespace

std::optional<geometry::OrientedBox> box_in_map(const geometry::Box2& box, double depth_m,
                                                std::string_view label, const geometry::Pose& map_from_camera,
                                                const geometry::CameraModel& camera,
                                                const TransformerConfig& config) {
  if (!is_finite(box) || !geometry::is_finite(map_from_camera) || !camera.is_valid()) return std::nullopt;
  if (!(depth_m >= config.min_depth_m && depth_m <= config.max_depth_m)) return std::nullopt;
  const geometry::Box2 seen = box.clipped(camera.width, camera.height);
  if (seen.width() < kSmallestSidePx || seen.height() < kSmallestSidePx) return std::nullopt;

  const Eigen::Vector3d top_left = depth_m * camera.ray({seen.x0, seen.y0});
  const Eigen::Vector3d bottom_right = depth_m * camera.ray({seen.x1, seen.y1});
  geometry::OrientedBox result;
  result.map_from_box = map_from_camera * Eigen::Translation3d((top_left + bottom_right) / 2);
  result.size = bottom_right - top_left;
  result.size.z() = config.labels[label].thickness_m;
  if (!geometry::is_valid(result)) return std::nullopt;
  return result;
}

}  // namespace rds::transformer
