// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/geometry/pose.hpp"

namespace rds::tracker {

/// The poses of a robot's body that its odometry has told in the last seconds, by stamp.
///
/// Where stamps go back, or the body moves as none can (the odometry has begun again somewhere else), the
/// poses before say nothing about those after: another segment begins.
class OdometryBuffer {
 public:
  static constexpr std::int64_t kKeptNs = 10'000'000'000;
  static constexpr std::int64_t kMaxGapNs = 500'000'000;     // between neighbours that are interpolated
  static constexpr std::int64_t kMaxAheadNs = 100'000'000;   // of the newest pose, at the last velocity
  static constexpr std::int64_t kMaxLateNs = 1'000'000'000;  // a pose with an older stamp: stamps went back

  struct Found {
    geometry::Pose odom_from_body = geometry::Pose::Identity();
    std::uint64_t segment = 0;
  };

  /// A pose that is late, or told twice, is dropped.
  void add(std::int64_t stamp_ns, const geometry::Pose& odom_from_body);
  /// Interpolated between neighbours, or a little beyond the newest; nullopt elsewhere.
  [[nodiscard]] std::optional<Found> at(std::int64_t stamp_ns) const;
  /// Stamp of the newest pose; nullopt before the first.
  [[nodiscard]] std::optional<std::int64_t> newest_ns() const;

 private:
  struct Told {
    std::int64_t stamp_ns;
    geometry::Pose odom_from_body;
  };

  std::deque<Told> told_;  // of one segment
  std::uint64_t segment_ = 0;
};

}  // namespace rds::tracker
