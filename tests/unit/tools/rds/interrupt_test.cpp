// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/cli/interrupt.hpp"

#include <csignal>
#include <cstdlib>

#include <gtest/gtest.h>
#include <unistd.h>

namespace rds {
namespace {

/// A program that is told to stop, begins to, and takes ten seconds for it.
[[noreturn]] void be_stopped_twice(int first, int second) {
  const Interrupt interrupt;
  kill(getpid(), first);
  while (!interrupt.token().stop_requested()) usleep(1000);
  kill(getpid(), second);
  sleep(10);
  std::exit(0);
}

TEST(Interrupt, ASecondSignalEndsTheProcessAtOnce) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(be_stopped_twice(SIGINT, SIGINT), testing::ExitedWithCode(130), "");
  EXPECT_EXIT(be_stopped_twice(SIGINT, SIGTERM), testing::ExitedWithCode(143), "");
}

}  // namespace
}  // namespace rds
