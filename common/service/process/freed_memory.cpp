// SPDX-License-Identifier: Apache-2.0
#include "common/service/process/freed_memory.hpp"

#include <cstddef>

#include <malloc.h>

namespace rds::service {
namespace {

constexpr int kPeriod = 5;                          // calls
constexpr std::size_t kMuch = 32ULL * 1024 * 1024;  // bytes

}  // namespace

void share_freed_memory() {
  mallopt(M_ARENA_MAX, 1);
}

void FreedMemory::look() {
  if (++calls_ % kPeriod != 0) return;
  const bool is_much = mallinfo2().fordblks > kMuch;
  if (is_much && was_much_) malloc_trim(0);
  was_much_ = is_much && !was_much_;
}

}  // namespace rds::service
