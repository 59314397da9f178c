// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/image_projection.hpp"

#include <algorithm>

namespace rds::tracker::prediction {
CutSides cut_sides(const geometry::OrientedBox& box, const geometry::Pose& camera_from_map,
                   const geometry::CameraModel& camera, double border_px) {
  const auto seen = image_box(box, camera_from_map, camera);
  if (!seen) return {};
  return {seen->x0 <= border_px, seen->y0 <= border_px, seen->x1 >= camera.width - border_px,
          seen->y1 >= camera.height - border_px};
}

geometry::Box2 with_reach(const geometry::Box2& box, double share, const geometry::CameraModel& camera) {
  const double x = share * box.width();
  const double y = share * box.height();
  return geometry::Box2{box.x0 - x, box.y0 - y, box.x1 + x, box.y1 + y}.clipped(camera.width, camera.height);
}

std::optional<PredictedBox> to_image(const geometry::OrientedBox& box, const geometry::Pose& camera_from_map,
                                     const geometry::CameraModel& camera) {
  const auto visible = image_box(box, camera_from_map, camera);
  if (!visible) return std::nullopt;
  const double m = kRegionMarginPx;
  const geometry::Box2 wide{visible->x0 - m, visible->y0 - m, visible->x1 + m, visible->y1 + m};
  const double depth = (camera_from_map * box.center()).z();
  const double reach = box.size.z() / 2 + kRegionMarginM;
  return PredictedBox{*visible,
                      {wide.clipped(camera.width, camera.height),
                       static_cast<float>(std::max(0.0, depth - reach)), static_cast<float>(depth + reach)}};
}

}  // namespace rds::tracker::prediction
