// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/movable_objects.hpp"

#include "services/tracker/core/prediction/observation_filter.hpp"
#include "services/tracker/core/prediction/visibility.hpp"

namespace rds::tracker {

std::vector<ImageObject> MovableObjects::in_image(std::int64_t stamp_ns,
                                                  const geometry::Pose& camera_from_map,
                                                  const geometry::CameraModel& camera) const {
  std::vector<ImageObject> objects;
  for (prediction::PredictedObject& object : predictor_.predict(stamp_ns)) {
    const auto box = prediction::to_image(object.box, camera_from_map, camera);
    if (!box) continue;
    const double reach = object.movable ? prediction::kReachShare : 0;
    objects.push_back({std::move(object), prediction::with_reach(box->box, reach, camera)});
  }
  return objects;
}

std::vector<segmentation::ObjectRegion> MovableObjects::regions(std::int64_t stamp_ns,
                                                   const geometry::Pose& camera_from_map,
                                                   const geometry::CameraModel& camera) const {
  std::vector<segmentation::ObjectRegion> regions;
  for (const prediction::PredictedObject& object : predictor_.predict(stamp_ns)) {
    if (!object.movable) continue;
    if (const auto box = prediction::to_image(object.box, camera_from_map, camera))
      regions.push_back(box->region);
  }
  return regions;
}

std::vector<segmentation::ObjectRegion> MovableObjects::regions_of(Observations observations,
                                                      const geometry::Pose& camera_from_map,
                                                      const geometry::CameraModel& camera) const {
  std::vector<segmentation::ObjectRegion> regions;
  for (const prediction::ObjectObservation& observation : observations) {
    if (!predictor_.config().labels[observation.label].movable ||
        !prediction::is_usable(observation, predictor_.config().min_score) ||
        prediction::is_implausible(observation, {camera_from_map.inverse(), camera}))
      continue;
    if (const auto box = prediction::to_image(observation.box, camera_from_map, camera))
      regions.push_back(box->region);
  }
  return regions;
}

}  // namespace rds::tracker
