// SPDX-License-Identifier: Apache-2.0
#include "common/concurrency/bounded_queue.hpp"

#include <thread>

#include <gtest/gtest.h>

namespace rds::concurrency {
namespace {

TEST(BoundedQueue, DropsTheOldestWhenFullAndCounts) {
  BoundedQueue<int> queue(2);
  for (int i = 0; i < 5; ++i) queue.push(i);
  EXPECT_EQ(queue.dropped(), 3U);
  EXPECT_EQ(queue.try_pop(), 3);
  EXPECT_EQ(queue.try_pop(), 4);
  EXPECT_EQ(queue.try_pop(), std::nullopt);
}

TEST(BoundedQueue, HandsOverInOrderBetweenThreads) {
  BoundedQueue<int> queue(10000);
  std::jthread producer([&queue] {
    for (int i = 0; i < 1000; ++i) queue.push(i);
  });
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(queue.pop({}), i);
}

TEST(BoundedQueue, StopWakesAWaitingConsumer) {
  BoundedQueue<int> queue(1);
  std::stop_source stop;
  std::jthread stopper([&stop] { stop.request_stop(); });
  EXPECT_EQ(queue.pop(stop.get_token()), std::nullopt);
}

}  // namespace
}  // namespace rds::concurrency
