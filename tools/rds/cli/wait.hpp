// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace rds::tools {

/// Asks `is_true` every 20 ms, for what the bus cannot notify (discovery). Ends at once when stop is
/// requested.
///
/// @return what it said last.
template <class Condition>
bool wait_until(std::chrono::steady_clock::time_point deadline, const std::stop_token& stop,
                Condition is_true) {
  constexpr std::chrono::milliseconds kPeriod{20};
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!is_true()) {
    const auto now = std::chrono::steady_clock::now();
    if (stop.stop_requested() || now >= deadline) return is_true();
    never.wait_until(lock, stop, std::min(deadline, now + kPeriod), [] { return false; });
  }
  return true;
}

}  // namespace rds::tools
