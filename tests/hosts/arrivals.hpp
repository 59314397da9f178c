// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include "common/bus/participant.hpp"
#include "rds_msgs/msg/TrackingState.h"
#include "vision_msgs/msg/Detection3DArray.h"

namespace rds::test {

/// When tracking states and boxes arrive at this process.
class Arrivals {
 public:
  explicit Arrivals(bus::Participant& bus);

  using Time = std::chrono::steady_clock::time_point;

  [[nodiscard]] std::size_t keyframes() const;
  /// When their tracking states came, by stamp.
  [[nodiscard]] std::map<std::int64_t, Time> keyframe_times() const;
  /// From the tracking state that tells of a keyframe, which follows its publication at once, to its boxes
  /// [ms], sorted; of those keyframes that were answered.
  [[nodiscard]] std::vector<double> answer_times_ms() const;
  [[nodiscard]] double longest_gap_s() const;

 private:
  void take(const rds_msgs::msg::TrackingState& state);
  void take(const vision_msgs::msg::Detection3DArray& boxes);

  mutable std::mutex mutex_;
  std::map<std::int64_t, Time> keyframes_;  // by stamp
  std::map<std::int64_t, Time> boxes_;      // the first of each stamp
  Time last_state_{};
  double longest_gap_s_ = 0;
  std::vector<bus::Subscription> subscriptions_;  // last: callbacks use the members above
};

}  // namespace rds::test
