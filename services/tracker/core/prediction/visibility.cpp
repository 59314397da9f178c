// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/visibility.hpp"

#include <algorithm>

#include "services/tracker/core/prediction/image_projection.hpp"

namespace rds::tracker::prediction {
namespace {

constexpr double kVisibleShare = 0.5;
constexpr double kWholePicture = 0.9;  // a box of more of the picture than this …
constexpr double kMinScore = 0.6;      // … has to have this score

double shared_area(const geometry::Box2& a, const geometry::Box2& b) {
  return geometry::Box2{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1),
                        std::min(a.y1, b.y1)}
      .area();
}

}  // namespace

bool should_be_detected(const geometry::OrientedBox& box, std::span<const ObjectObservation> detected,
                        const KeyframeView& view) {
  const geometry::Pose camera_from_map = view.map_from_camera.inverse();
  const auto whole = whole_image_box(box, camera_from_map, view.camera);
  if (!whole) return false;
  const geometry::Box2 visible = whole->clipped(view.camera.width, view.camera.height);
  if (!(visible.area() >= kVisibleShare * whole->area()) || !(visible.area() > 0)) return false;
  const double depth = (camera_from_map * box.center()).z();
  return std::ranges::none_of(detected, [&](const ObjectObservation& other) {
    const auto front = image_box(other.box, camera_from_map, view.camera);
    return front && (camera_from_map * other.box.center()).z() < depth &&
           shared_area(*front, visible) >= kVisibleShare * visible.area();
  });
}

bool is_implausible(const ObjectObservation& observation, const KeyframeView& view) {
  if (static_cast<double>(observation.score) >= kMinScore) return false;
  const auto box = image_box(observation.box, view.map_from_camera.inverse(), view.camera);
  return box && box->area() > kWholePicture * view.camera.width * view.camera.height;
}

}  // namespace rds::tracker::prediction
