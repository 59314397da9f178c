// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/epoch_follower.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace rds::mapper {
namespace {

using service::Rejection;

constexpr std::size_t kMaxEarlier = 16;
constexpr std::size_t kMaxPoses = 100;
constexpr std::chrono::seconds kSilent{3};
constexpr std::uint64_t kPosesMark = std::numeric_limits<std::uint64_t>::max();  // no keyframe's id

}  // namespace

std::optional<Refusal> EpochFollower::hear_tracker(std::uint64_t instance, std::uint64_t map_epoch,
                                                   std::uint64_t current, Clock::time_point now) {
  const bool same_map = map_epoch == current;
  if (!accepts_(instance, same_map)) return Refusal{Rejection::kForeign, "another tracker"};
  if (std::exchange(tracker_, instance) != instance) earlier_.clear();
  if (same_map) {
    next_.deny();
    heard_ = now;
  } else if (is_over(map_epoch, now)) {
    return Refusal{Rejection::kOutdated, "an earlier map epoch"};
  }
  return std::nullopt;
}

/// Messages of an epoch that is over may still be on their way. But an epoch that goes on while the one that
/// followed it is silent is not over.
bool EpochFollower::is_over(std::uint64_t map_epoch, Clock::time_point now) {
  if (std::ranges::count(earlier_, map_epoch) == 0) return false;
  if (now - heard_ < kSilent) return true;
  std::erase(earlier_, map_epoch);
  return false;
}

std::vector<EpochFollower::Images> EpochFollower::confirm(const Images& keyframe) {
  if (!next_.confirm(keyframe->instance(), keyframe->map_epoch(), keyframe->keyframe_id())) {
    first_of_next_ = keyframe;
    return {};
  }
  const Images first = std::exchange(first_of_next_, nullptr);
  if (!first || first->map_epoch() != keyframe->map_epoch()) return {keyframe};
  return {first, keyframe};
}

EpochFollower::Images EpochFollower::confirm(const Poses& poses) {
  const bool is_confirmed = next_.confirm(poses->instance(), poses->map_epoch(), kPosesMark);
  if (!is_confirmed || !first_of_next_ || first_of_next_->map_epoch() != poses->map_epoch()) return nullptr;
  return std::exchange(first_of_next_, nullptr);
}

void EpochFollower::keep(const Poses& poses) {
  if (poses_of_next_.size() >= kMaxPoses) poses_of_next_.clear();  // another message with all poses will come
  poses_of_next_.push_back(poses);
}

std::vector<EpochFollower::Poses> EpochFollower::begin(std::uint64_t over, Clock::time_point now) {
  earlier_.push_back(over);
  if (earlier_.size() > kMaxEarlier) earlier_.pop_front();
  heard_ = now;
  return std::exchange(poses_of_next_, {});
}

}  // namespace rds::mapper
