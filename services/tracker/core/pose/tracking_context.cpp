// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/tracking_context.hpp"

namespace rds::tracker {

std::shared_ptr<const FeatureSet> complete_feature_set(const TrackingContext& context,
                                                       std::vector<Feature>&& features) {
  const image::RgbdFrame& picture = context.picture;
  complete_features(picture.camera, picture.depth, context.settings.depth.max_depth_m, features);
  remove_rolling_shutter(picture.camera, context.frame.motion, features);
  return std::make_shared<const FeatureSet>(picture.camera, std::move(features));
}

int optimize(const TrackingContext& context, TrackedFrame& frame) {
  return optimize_frame(context.map, context.model, context.settings.pyramid, frame);
}

void count_found_points(SlamMap& map, const TrackedFrame& frame) {
  for (const PointId id : frame.points) {
    MapPoint* point = map.point(id);
    if (point == nullptr) continue;
    ++point->found;
    point->last_found_ns = frame.time_ns;
  }
}

}  // namespace rds::tracker
