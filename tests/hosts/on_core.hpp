// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

namespace rds::test {

/// While it lives the calling thread, and all that it starts, is held to one processor core.
class OnCore {
 public:
  /// @param core  below 0: any.
  explicit OnCore(int core) {
    sched_getaffinity(0, sizeof before_, &before_);
    if (core < 0) return;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(core, &one);
    sched_setaffinity(0, sizeof one, &one);
  }
  ~OnCore() { sched_setaffinity(0, sizeof before_, &before_); }
  OnCore(const OnCore&) = delete;
  OnCore& operator=(const OnCore&) = delete;

 private:
  cpu_set_t before_{};
};

}  // namespace rds::test
