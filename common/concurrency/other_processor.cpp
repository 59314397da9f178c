// SPDX-License-Identifier: Apache-2.0
#include "common/concurrency/other_processor.hpp"

#include <cstddef>

namespace rds::concurrency {

OtherProcessor::OtherProcessor(pthread_t thread) : thread_(thread) {
  if (pthread_getaffinity_np(thread_, sizeof(allowed_), &allowed_) != 0) CPU_ZERO(&allowed_);
}

void OtherProcessor::keep_off_mine() {
  const int mine = sched_getcpu();
  if (mine == kept_off_ || mine < 0 || mine >= CPU_SETSIZE) return;
  kept_off_ = mine;
  cpu_set_t others = allowed_;
  CPU_CLR(static_cast<std::size_t>(mine), &others);
  if (CPU_COUNT(&others) > 0) pthread_setaffinity_np(thread_, sizeof(others), &others);
}

}  // namespace rds::concurrency
