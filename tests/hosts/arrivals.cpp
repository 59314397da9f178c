// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/arrivals.hpp"

#include <algorithm>

#include "common/messages/conversions.hpp"
#include "common/topics/topics.hpp"

namespace rds::test {

using rds_msgs::msg::TrackingState;
using vision_msgs::msg::Detection3DArray;
using Clock = std::chrono::steady_clock;

Arrivals::Arrivals(bus::Participant& bus) {
  subscriptions_.push_back(bus.subscribe<TrackingState>(
      topics::kTrackingState.name, bus::kStream,
      [this](const std::shared_ptr<const TrackingState>& state) { take(*state); }));
  subscriptions_.push_back(bus.subscribe<Detection3DArray>(
      topics::kBoxes.name, bus::kStream,
      [this](const std::shared_ptr<const Detection3DArray>& boxes) { take(*boxes); }));
}

void Arrivals::take(const TrackingState& state) {
  const std::lock_guard lock(mutex_);
  const Time now = Clock::now();
  if (last_state_ != Time{})
    longest_gap_s_ = std::max(longest_gap_s_, std::chrono::duration<double>(now - last_state_).count());
  last_state_ = now;
  if (state.is_keyframe()) keyframes_.emplace(messages::to_nanoseconds(state.header().stamp()), now);
}

void Arrivals::take(const Detection3DArray& boxes) {
  const std::lock_guard lock(mutex_);
  boxes_.emplace(messages::to_nanoseconds(boxes.header().stamp()), Clock::now());
}

std::size_t Arrivals::keyframes() const {
  const std::lock_guard lock(mutex_);
  return keyframes_.size();
}

std::map<std::int64_t, Arrivals::Time> Arrivals::keyframe_times() const {
  const std::lock_guard lock(mutex_);
  return keyframes_;
}

std::vector<double> Arrivals::answer_times_ms() const {
  const std::lock_guard lock(mutex_);
  std::vector<double> times;
  for (const auto& [stamp, published] : keyframes_)
    if (const auto boxes = boxes_.find(stamp); boxes != boxes_.end())
      times.push_back(std::chrono::duration<double, std::milli>(boxes->second - published).count());
  std::ranges::sort(times);
  return times;
}

double Arrivals::longest_gap_s() const {
  const std::lock_guard lock(mutex_);
  return longest_gap_s_;
}

}  // namespace rds::test
