// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <Eigen/Geometry>

namespace rds::tracker {

/// Turn rates that a gyroscope has told in the last seconds, by stamp. Stamps that go back begin anew.
class GyroscopeBuffer {
 public:
  static constexpr std::int64_t kKeptNs = 5'000'000'000;
  static constexpr std::int64_t kMaxGapNs = 50'000'000;      // between neighbours
  static constexpr std::int64_t kMaxAheadNs = 20'000'000;    // of the newest one, at its rate
  static constexpr std::int64_t kMaxLateNs = 1'000'000'000;  // one with an older stamp: stamps went back

  /// One that is late, or told twice, is dropped; so is one that is no number.
  void add(std::int64_t stamp_ns, const Eigen::Vector3d& rate_rad_per_s);
  /// The body's turn between two times, earlier_from_later, by linear rates between the measurements; nullopt
  /// where they do not cover it.
  [[nodiscard]] std::optional<Eigen::Quaterniond> turn(std::int64_t from_ns, std::int64_t to_ns) const;

 private:
  struct Rate {
    std::int64_t stamp_ns;
    Eigen::Vector3d rad_per_s;
  };
  static Eigen::Vector3d rate_at(const Rate& before, const Rate& after, std::int64_t stamp_ns);

  std::deque<Rate> rates_;
};

/// exp of a rotation vector [rad].
Eigen::Quaterniond turn_by(const Eigen::Vector3d& rotation_rad);
/// Its inverse, of at most half a turn.
Eigen::Vector3d rotation_of(const Eigen::Quaterniond& turn);

}  // namespace rds::tracker
