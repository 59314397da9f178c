// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/level/gravity.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ranges>

namespace rds::tracker {

void Gravity::add(const image::ImuMeasurement& measurement) {
  if (!kept_.empty() && measurement.stamp_ns < kept_.back().stamp_ns) kept_.clear();
  kept_.push_back(measurement);
  while (kept_.front().stamp_ns < measurement.stamp_ns - kKeptNs) kept_.pop_front();
}

std::optional<Eigen::Vector3d> Gravity::up(std::int64_t stamp_ns) const {
  if (kept_.empty()) return std::nullopt;
  const auto by_stamp = &image::ImuMeasurement::stamp_ns;
  const std::int64_t end_ns = stamp_ns < kept_.front().stamp_ns ? kept_.back().stamp_ns : stamp_ns;
  const auto end = std::ranges::upper_bound(kept_, end_ns, {}, by_stamp);
  const std::ranges::subrange window(
      std::ranges::lower_bound(kept_.begin(), end, std::prev(end)->stamp_ns - kWindowNs, {}, by_stamp), end);
  const auto count = static_cast<std::size_t>(window.size());
  if (count < kLeast || std::prev(end)->stamp_ns - window.front().stamp_ns < kWindowNs / 2)
    return std::nullopt;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& m : window) sum += m.acceleration;
  const Eigen::Vector3d mean = sum / static_cast<double>(count);
  if (!(std::abs(mean.norm() - kStandardGravity) <= kMaxOff)) return std::nullopt;
  const bool stands_still = std::ranges::all_of(window, [&](const image::ImuMeasurement& m) {
    return (m.acceleration - mean).norm() <= kMaxShake && m.turn_rate.norm() <= kMaxTurnRate;
  });
  return stands_still ? std::optional<Eigen::Vector3d>(mean.normalized()) : std::nullopt;
}

}  // namespace rds::tracker
