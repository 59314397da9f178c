// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <Eigen/Core>

#include "common/image/sensors/robot_sensors.hpp"

namespace rds::tracker {

/// Which way is up by an accelerometer: its mean over half a second in which the unit stood still.
class Gravity {
 public:
  static constexpr std::int64_t kWindowNs = 500'000'000;
  static constexpr std::size_t kLeast = 10;         // measurements in it
  static constexpr double kStandardGravity = 9.81;  // m/s²; on Earth it differs by .03
  static constexpr double kMaxOff = 0.5;            // m/s², of the mean's length: what is not gravity, 3°
  static constexpr double kMaxShake = 0.3;          // m/s², of one measurement from the mean: noise, no step
  static constexpr double kMaxTurnRate = 0.05;      // rad/s, with the bias of a cheap gyroscope

  /// A measurement with an earlier stamp than the newest one begins anew.
  void add(const image::ImuMeasurement& measurement);
  /// Unit vector in the unit's frame, at a time, or the latest where the stamps are of another clock; nullopt
  /// while it moves, or too little is known.
  [[nodiscard]] std::optional<Eigen::Vector3d> up(std::int64_t stamp_ns) const;

 private:
  static constexpr std::int64_t kKeptNs = 4 * kWindowNs;  // a picture comes later than what follows it

  std::deque<image::ImuMeasurement> kept_;
};

}  // namespace rds::tracker
