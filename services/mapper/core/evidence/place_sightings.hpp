// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace rds::mapper {

/// Times [ns] before and after all others; their differences from others do not overflow.
inline constexpr std::int64_t kBeforeAll = std::numeric_limits<std::int64_t>::min() / 2;
inline constexpr std::int64_t kAfterAll = std::numeric_limits<std::int64_t>::max() / 2;

/// When, and in how many keyframes, something was seen in one place; default: in none.
struct PlaceSightings {
  std::int64_t first_ns = kAfterAll;
  std::int64_t last_ns = kBeforeAll;
  std::int64_t counted_ns = kBeforeAll;  // of the keyframe counted last: its pixels come in one go
  std::uint32_t keyframes = 0;

  void add(std::int64_t time_ns) {
    first_ns = std::min(first_ns, time_ns);
    last_ns = std::max(last_ns, time_ns);
    keyframes += time_ns == counted_ns ? 0 : 1;
    counted_ns = time_ns;
  }
};

}  // namespace rds::mapper
