// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/odometry_buffer.hpp"

#include <algorithm>
#include <iterator>

#include "services/tracker/core/motion/motion_model.hpp"
#include "services/tracker/core/motion/se3.hpp"

namespace rds::tracker {
namespace {

constexpr double kNsPerSecond = 1e9;

}  // namespace

void OdometryBuffer::add(std::int64_t stamp_ns, const geometry::Pose& odom_from_body) {
  if (!told_.empty()) {
    const Told& last = told_.back();
    const double gap_s = static_cast<double>(stamp_ns - last.stamp_ns) / kNsPerSecond;
    if (stamp_ns <= last.stamp_ns && stamp_ns > last.stamp_ns - kMaxLateNs) return;
    const MotionPrediction still(last.odom_from_body, std::nullopt, gap_s);
    if (stamp_ns < last.stamp_ns || still.is_jump(odom_from_body.inverse())) {
      told_.clear();
      ++segment_;
    }
  }
  told_.push_back({stamp_ns, odom_from_body});
  while (told_.front().stamp_ns < stamp_ns - kKeptNs) told_.pop_front();
}

std::optional<OdometryBuffer::Found> OdometryBuffer::at(std::int64_t stamp_ns) const {
  const auto after = std::ranges::lower_bound(told_, stamp_ns, {}, &Told::stamp_ns);
  if (after != told_.end() && after->stamp_ns == stamp_ns) return Found{after->odom_from_body, segment_};
  if (after == told_.begin()) return std::nullopt;
  const bool is_ahead = after == told_.end();
  if (is_ahead && (told_.size() < 2 || stamp_ns > told_.back().stamp_ns + kMaxAheadNs)) return std::nullopt;
  const Told& b = is_ahead ? told_.back() : *after;
  const Told& a = *std::prev(is_ahead ? std::prev(told_.end()) : after);
  if (b.stamp_ns - a.stamp_ns > kMaxGapNs) return std::nullopt;
  const double share =
      static_cast<double>(stamp_ns - a.stamp_ns) / static_cast<double>(b.stamp_ns - a.stamp_ns);
  const Twist motion = se3_log(a.odom_from_body.inverse() * b.odom_from_body);
  return Found{a.odom_from_body * se3_exp(share * motion), segment_};
}

std::optional<std::int64_t> OdometryBuffer::newest_ns() const {
  return told_.empty() ? std::nullopt : std::optional(told_.back().stamp_ns);
}

}  // namespace rds::tracker
