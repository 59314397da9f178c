// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace rds::time {

/// Of a clock that never steps.
inline std::int64_t now_us() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

inline std::uint32_t microseconds_since(std::int64_t start_us) {
  return static_cast<std::uint32_t>(now_us() - start_us);
}

}  // namespace rds::time
