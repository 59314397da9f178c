// SPDX-License-Identifier: Apache-2.0
#include "common/concurrency/other_processor.hpp"

#include <cstddef>
#include <latch>
#include <thread>

#include <gtest/gtest.h>

namespace rds::concurrency {
namespace {

cpu_set_t processors_of(pthread_t thread) {
  cpu_set_t set{};
  EXPECT_EQ(pthread_getaffinity_np(thread, sizeof(set), &set), 0);
  return set;
}

TEST(OtherProcessor, IsAnyButTheCallersAndFollowsIt) {
  const cpu_set_t mine = processors_of(pthread_self());
  std::latch end(1);
  std::thread other([&] { end.wait(); });
  OtherProcessor processor(other.native_handle());
  for (std::size_t cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &mine)) continue;
    cpu_set_t here{};
    CPU_SET(cpu, &here);
    ASSERT_EQ(pthread_setaffinity_np(pthread_self(), sizeof(here), &here), 0);
    processor.keep_off_mine();
    const cpu_set_t others = processors_of(other.native_handle());
    const bool alone = CPU_COUNT(&mine) == 1;
    EXPECT_EQ(CPU_ISSET(cpu, &others) != 0, alone);
    EXPECT_EQ(CPU_COUNT(&others), alone ? 1 : CPU_COUNT(&mine) - 1);
  }
  pthread_setaffinity_np(pthread_self(), sizeof(mine), &mine);
  end.count_down();
  other.join();
}

}  // namespace
}  // namespace rds::concurrency
