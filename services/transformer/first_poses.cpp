// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/first_poses.hpp"

#include "common/time/stamp_step.hpp"

namespace rds::transformer {

void FirstPoses::take(std::span<const geometry::KeyframePose> poses) {
  for (const geometry::KeyframePose& pose : poses) {
    if (pose.id < next_id_) continue;
    next_id_ = pose.id + 1;
    const bool goes_back = !by_id_.empty() && time::step_between(by_id_.rbegin()->second.stamp_ns,
                                                                 pose.stamp_ns) == time::StampStep::kBack;
    if (goes_back) {
      by_id_.clear();
      id_of_stamp_.clear();
    }
    by_id_.emplace(pose.id, pose);
    id_of_stamp_.insert_or_assign(pose.stamp_ns, pose.id);
    if (by_id_.size() <= capacity_) continue;
    const auto oldest = by_id_.begin();
    if (const auto stamp = id_of_stamp_.find(oldest->second.stamp_ns); stamp->second == oldest->first)
      id_of_stamp_.erase(stamp);
    by_id_.erase(oldest);
  }
}

std::optional<geometry::Pose> FirstPoses::of(std::int64_t stamp_ns) const {
  const auto id = id_of_stamp_.find(stamp_ns);
  if (id == id_of_stamp_.end()) return std::nullopt;
  return by_id_.at(id->second).map_from_camera;
}

void FirstPoses::clear() {
  by_id_.clear();
  id_of_stamp_.clear();
  next_id_ = 0;
}

}  // namespace rds::transformer
