// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/keyframe_data.hpp"

namespace rds::tracker {

KeyframeData keyframe_data(const SlamMap& map, const Keyframe& keyframe) {
  KeyframeData data;
  data.id = keyframe.id;
  data.stamp_ns = keyframe.stamp_ns;
  data.map_from_camera = keyframe.map_from_camera;
  data.features.reserve(keyframe.points.size());
  for (std::size_t i = 0; i < keyframe.points.size(); ++i)
    data.features.push_back(
        {(*keyframe.features)[i], keyframe.features->point_in_camera(i).cast<float>(),
         keyframe.points[i] == kNoId ? -1 : static_cast<std::int64_t>(keyframe.points[i])});
  for (const CovisibleKeyframe& c : keyframe.covisible)
    data.covisible.push_back({c.id, c.weight, map.pose_of(c.id)});
  return data;
}

}  // namespace rds::tracker
