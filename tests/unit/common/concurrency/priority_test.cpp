// SPDX-License-Identifier: Apache-2.0
#include "common/concurrency/priority.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace rds::concurrency {
namespace {

int niceness() {
  return getpriority(PRIO_PROCESS, 0);
}

TEST(Priority, OnlyTheCallingThreadGivesWayAndWhatItStarts) {
  const int before = niceness();
  int own = 0;
  int child = 0;
  std::jthread([&] {
    EXPECT_TRUE(give_way(before + 1));
    own = niceness();
    std::jthread([&] { child = niceness(); }).join();
  }).join();
  EXPECT_EQ(own, before + 1);
  EXPECT_EQ(child, before + 1);
  EXPECT_EQ(niceness(), before);
}

TEST(Priority, NeverComesBack) {
  std::jthread([] {
    const int before = niceness();
    EXPECT_TRUE(give_way(before + 2));
    EXPECT_TRUE(give_way(before + 1));
    EXPECT_EQ(niceness(), before + 2);
  }).join();
}

TEST(Priority, WhatIsCalledGivesWayWithTheThreadsThatItStarts) {
  const int before = niceness();
  const auto of_child = [] {
    int child = 0;
    std::jthread([&] { child = niceness(); }).join();
    return child;
  };
  EXPECT_EQ(giving_way(before + 1, of_child), before + 1);
  EXPECT_EQ(niceness(), before);
  EXPECT_THROW(giving_way(before + 1, [] { throw std::runtime_error("no"); }), std::runtime_error);
}

TEST(Priority, AProcessGivesWayWithTheThreadsItHasAlready) {
  const int before = niceness();
  std::atomic<bool> lowered = false;
  int of_other = 0;
  std::jthread other([&] {
    lowered.wait(false);
    of_other = niceness();
  });
  EXPECT_TRUE(give_way_as_process(before + 1));
  lowered = true;
  lowered.notify_all();
  other.join();
  EXPECT_EQ(of_other, before + 1);
  EXPECT_EQ(niceness(), before + 1);
}

}  // namespace
}  // namespace rds::concurrency
