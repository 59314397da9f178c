// SPDX-License-Identifier: Apache-2.0
#include "services/transformer/first_poses.hpp"

#include <algorithm>
#include <iterator>

#include "common/time/stamp_step.hpp"

namespace rds::transformer {
namespace {

constexpr std::uint64_t kMaxStep = 1'000'000;

}  // namespace

void FirstPoses::take(std::span<const geometry::KeyframePose> poses) {
  for (const geometry::KeyframePose& pose : poses) {
    if (pose.id < first_id_ || by_id_.contains(pose.id) || is_impossible(pose)) continue;
    if (goes_back(pose)) forget_before(pose.id);
    by_id_.emplace(pose.id, pose);
    std::uint64_t& newest_of_stamp = id_of_stamp_.try_emplace(pose.stamp_ns, pose.id).first->second;
    newest_of_stamp = std::max(newest_of_stamp, pose.id);
    if (by_id_.size() > capacity_) forget_before(std::next(by_id_.begin())->first);
  }
}

/// Ids count up, and a tracker that was started again leaves some thousands out.
bool FirstPoses::is_impossible(const geometry::KeyframePose& pose) const {
  return !by_id_.empty() && pose.id > by_id_.rbegin()->first + kMaxStep;
}

/// Whether it is newer than all others and of an earlier time.
bool FirstPoses::goes_back(const geometry::KeyframePose& pose) const {
  if (by_id_.empty() || pose.id < by_id_.rbegin()->first) return false;
  return time::step_between(by_id_.rbegin()->second.stamp_ns, pose.stamp_ns) == time::StampStep::kBack;
}

void FirstPoses::forget_before(std::uint64_t id) {
  first_id_ = id;
  by_id_.erase(by_id_.begin(), by_id_.lower_bound(id));
  std::erase_if(id_of_stamp_, [&](const auto& entry) { return entry.second < id; });
}

std::optional<geometry::Pose> FirstPoses::of(std::int64_t stamp_ns) const {
  const auto id = id_of_stamp_.find(stamp_ns);
  if (id == id_of_stamp_.end()) return std::nullopt;
  return by_id_.at(id->second).map_from_camera;
}

void FirstPoses::clear() {
  by_id_.clear();
  id_of_stamp_.clear();
  first_id_ = 0;
}

}  // namespace rds::transformer
