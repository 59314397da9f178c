// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/bus/participant.hpp"
#include "rds_msgs/msg/OctreeDelta.h"

namespace rds::test {

constexpr double kNever = std::numeric_limits<double>::max();

/// How a reader of the map on another machine fared.
struct FollowerFigures {
  double first_s = 0;       // from its start to its first map; kNever: none came
  double behind_p95_s = 0;  // from a revision's arrival beside the mapper to its arrival there, after that
  double behind_max_s = 0;
  std::size_t steps = 0;  // changes of its copy
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FollowerFigures, first_s, behind_p95_s, behind_max_s, steps)

/// When the revisions of the map arrive at this process, which is beside the mapper.
class Revisions {
 public:
  explicit Revisions(bus::Participant& bus);

  /// From the moments at which keyframes were published to their deltas [ms], sorted.
  /// @param keyframes  moments of the steady clock, by stamp.
  [[nodiscard]] std::vector<double> delays_ms(
      const std::map<std::int64_t, std::chrono::steady_clock::time_point>& keyframes) const;
  /// @param printed  lines of map_follower. @param end_s  when it was looked at; what has not arrived by then
  /// counts as if it did then.
  [[nodiscard]] FollowerFigures follower(const std::string& printed, double end_s) const;
  [[nodiscard]] std::uint64_t newest() const;

 private:
  void take(const rds_msgs::msg::OctreeDelta& delta);

  mutable std::mutex mutex_;
  std::map<std::uint64_t, double> by_revision_;  // [s] of the steady clock
  std::map<std::int64_t, std::chrono::steady_clock::time_point> by_stamp_;
  bus::Subscription subscription_;  // last: its callback uses the members above
};

double steady_s();

}  // namespace rds::test
