// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_history.hpp"

#include <set>

namespace rds::loop_closer {

bool is_consistent(const LoopDetection& a, const LoopDetection& b, const ConsistencyConfig& config) {
  const geometry::Pose difference = a.correction.inverse() * b.correction;
  const double moved_m = (a.correction * b.query_in_map - b.correction * b.query_in_map).norm();
  return moved_m <= config.max_difference_m &&
         geometry::rotation_angle_rad(difference.linear()) <= config.max_difference_rad;
}

std::vector<LoopDetection> LoopHistory::add(const LoopDetection& detection) {
  const auto window = static_cast<std::size_t>(config_.window_keyframes);
  while (!detections_.empty() && detections_.front().query + window <= detection.query)
    detections_.pop_front();
  std::vector<LoopDetection> agreeing;
  std::set<std::size_t> queries{detection.query};
  for (const LoopDetection& earlier : detections_) {
    if (!is_consistent(detection, earlier, config_)) continue;
    agreeing.push_back(earlier);
    queries.insert(earlier.query);
  }
  detections_.push_back(detection);
  agreeing.push_back(detection);
  if (queries.size() < static_cast<std::size_t>(config_.min_detections)) agreeing.clear();
  return agreeing;
}

}  // namespace rds::loop_closer
