// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rds::time {

/// How a stamp follows the newest one before it.
enum class StampStep : std::uint8_t {
  kOn,     // time goes on
  kGap,    // by more than kGapNs: nothing came for a while
  kAhead,  // by more than kAheadNs: a long gap, or another clock
  kLate,   // not later, but by no more than kLateNs: repeated, or overtaken on the way
  kBack    // earlier by more: a recording that begins again, a clock that was set
};

/// The last frame says nothing any more about where the camera is.
inline constexpr std::int64_t kGapNs = 2'000'000'000;
/// A driver that restarts needs 2 – 8 s; who is away for longer loses one frame by being doubted.
inline constexpr std::int64_t kAheadNs = 10'000'000'000;
/// A bus repeats and reorders within tens of milliseconds, and NTP slews a clock by less than this. A clock
/// that is set back by less costs as much time without frames, and nothing else.
inline constexpr std::int64_t kLateNs = 500'000'000;

/// @param newest_ns, next_ns  as ROS stamps can be: of int32 seconds.
[[nodiscard]] StampStep step_between(std::int64_t newest_ns, std::int64_t next_ns);

}  // namespace rds::time
