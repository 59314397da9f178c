// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/triangulation/triangulated_points.hpp"

#include <algorithm>
#include <utility>

#include "services/tracker/core/triangulation/triangulation.hpp"

namespace rds::tracker {

bool rests_on_views(const SlamMap& map, const MapPoint& point) {
  return point.is_triangulated && std::ranges::none_of(point.observations, [&](const Observation& o) {
    return (*map.keyframe(o.keyframe)->features)[o.feature].depth_m > 0;
  });
}

void erase_if_unknown(SlamMap& map, PointId id) {
  const MapPoint* point = std::as_const(map).point(id);
  if (point == nullptr || !rests_on_views(map, *point)) return;
  std::vector<PointView> views;
  for (const Observation& o : point->observations) {
    const Keyframe& k = *std::as_const(map).keyframe(o.keyframe);
    const ObservationModel model(k.features->camera());
    views.push_back(
        {k.map_from_camera.inverse(), model, model.measurement((*k.features)[o.feature], map.pyramid())});
  }
  const bool is_known = views.size() >= kMinTriangulatingViews &&
                        is_known_well({point->position, covariance_at(views, point->position)}, views.back());
  if (!is_known) map.erase_point(id);
}

}  // namespace rds::tracker
