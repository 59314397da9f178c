// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace rds::tracker {

/// Calls part(0) … part(count − 1), each once, in any order, also at the same time, and returns when all are
/// done. Parts are independent of each other, so that results do not depend on who runs them where.
using Executor = std::function<void(std::size_t count, const std::function<void(std::size_t)>& part)>;

/// Executor on the calling thread.
inline void execute_serially(std::size_t count, const std::function<void(std::size_t)>& part) {
  for (std::size_t i = 0; i < count; ++i) part(i);
}

/// Calls both, also at the same time.
inline void run_both(const Executor& executor, const std::function<void()>& first,
                     const std::function<void()>& second) {
  executor(2, [&](std::size_t part) { part == 0 ? first() : second(); });
}

}  // namespace rds::tracker
