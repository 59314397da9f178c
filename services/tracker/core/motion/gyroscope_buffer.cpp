// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/gyroscope_buffer.hpp"

#include <algorithm>

namespace rds::tracker {
namespace {

constexpr double kSecondsPerNs = 1e-9;

}  // namespace

Eigen::Quaterniond turn_by(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_rad / angle));
}

Eigen::Vector3d rotation_of(const Eigen::Quaterniond& turn) {
  const Eigen::AngleAxisd rotation(turn);
  return rotation.angle() * rotation.axis();
}

void GyroscopeBuffer::add(std::int64_t stamp_ns, const Eigen::Vector3d& rate_rad_per_s) {
  if (!rate_rad_per_s.allFinite()) return;
  if (!rates_.empty() && stamp_ns <= rates_.back().stamp_ns) {
    if (rates_.back().stamp_ns - stamp_ns < kMaxLateNs) return;
    rates_.clear();
  }
  rates_.push_back({stamp_ns, rate_rad_per_s});
  while (rates_.front().stamp_ns < stamp_ns - kKeptNs) rates_.pop_front();
}

Eigen::Vector3d GyroscopeBuffer::rate_at(const Rate& before, const Rate& after, std::int64_t stamp_ns) {
  const double share =
      static_cast<double>(stamp_ns - before.stamp_ns) / static_cast<double>(after.stamp_ns - before.stamp_ns);
  return before.rad_per_s + share * (after.rad_per_s - before.rad_per_s);
}

std::optional<Eigen::Quaterniond> GyroscopeBuffer::turn(std::int64_t from_ns, std::int64_t to_ns) const {
  if (rates_.empty() || from_ns > to_ns || from_ns < rates_.front().stamp_ns ||
      to_ns > rates_.back().stamp_ns + kMaxAheadNs)
    return std::nullopt;
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
  const auto by_stamp = [](std::int64_t stamp_ns, const Rate& rate) { return stamp_ns < rate.stamp_ns; };
  auto after = std::upper_bound(rates_.begin(), rates_.end(), from_ns, by_stamp);
  for (std::int64_t at_ns = from_ns; at_ns < to_ns; ++after) {
    const Rate& before = *std::prev(after);
    const bool is_last = after == rates_.end();
    if (!is_last && after->stamp_ns - before.stamp_ns > kMaxGapNs) return std::nullopt;
    const std::int64_t next_ns = is_last ? to_ns : std::min(to_ns, after->stamp_ns);
    const std::int64_t middle_ns = at_ns + (next_ns - at_ns) / 2;
    const Eigen::Vector3d rate = is_last ? before.rad_per_s : rate_at(before, *after, middle_ns);
    turned = turned * turn_by(static_cast<double>(next_ns - at_ns) * kSecondsPerNs * rate);
    at_ns = next_ns;
    if (is_last) break;
  }
  return turned.normalized();
}

}  // namespace rds::tracker
