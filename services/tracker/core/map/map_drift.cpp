// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/map_drift.hpp"

#include <map>

namespace rds::tracker {

Matrix6 MapDrift::under(const SlamMap& map, std::span<const PointId> points,
                        const Pose& map_from_camera) const {
  std::map<KeyframeId, int> brought;
  int all = 0;
  for (const PointId id : points) {
    const MapPoint* point = map.point(id);
    if (point == nullptr) continue;
    ++brought[point->created_by];
    ++all;
  }
  Matrix6 sum = Matrix6::Zero();
  const Pose camera_from_map = map_from_camera.inverse();
  for (const auto& [keyframe, count] : brought) {
    const auto known = covariances_.find(keyframe);
    if (known == covariances_.end()) continue;
    const Matrix6 moved = adjoint(camera_from_map * map.pose_of(keyframe));
    sum.noalias() += static_cast<double>(count) / all * moved * known->second * moved.transpose();
  }
  return (sum + sum.transpose()) / 2;
}

}  // namespace rds::tracker
