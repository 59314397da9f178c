// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/level/gravity.hpp"

#include <algorithm>
#include <cmath>

namespace rds::tracker {

void Gravity::add(const image::ImuMeasurement& measurement) {
  if (!window_.empty() && measurement.stamp_ns < window_.back().stamp_ns) window_.clear();
  window_.push_back(measurement);
  while (window_.front().stamp_ns < measurement.stamp_ns - kWindowNs) window_.pop_front();
}

std::optional<Eigen::Vector3d> Gravity::up() const {
  if (window_.size() < kLeast || window_.back().stamp_ns - window_.front().stamp_ns < kWindowNs / 2)
    return std::nullopt;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& m : window_) sum += m.acceleration;
  const Eigen::Vector3d mean = sum / static_cast<double>(window_.size());
  if (!(std::abs(mean.norm() - kStandardGravity) <= kMaxOff)) return std::nullopt;
  const bool stands_still = std::ranges::all_of(window_, [&](const image::ImuMeasurement& m) {
    return (m.acceleration - mean).norm() <= kMaxShake && m.turn_rate.norm() <= kMaxTurnRate;
  });
  return stands_still ? std::optional<Eigen::Vector3d>(mean.normalized()) : std::nullopt;
}

}  // namespace rds::tracker
