// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/window.hpp"

#include <gtest/gtest.h>

namespace rds::transfer {
namespace {

using namespace std::chrono_literals;

TEST(Window, GrowsWhileTheDelayDoesNot) {
  Window window;
  const std::size_t first = window.chunks();
  Time now = 1s;
  for (int i = 0; i < 500; ++i) window.arrived(now += 1ms, 20ms, false, window.chunks());
  EXPECT_GT(window.chunks(), 4 * first);
}

TEST(Window, StaysWhereItIsNotUsed) {
  Window window;
  const std::size_t first = window.chunks();
  for (int i = 0; i < 500; ++i) window.arrived(1s + i * 1ms, 20ms, false, 1);
  EXPECT_EQ(window.chunks(), first);
}

TEST(Window, ShrinksWhenChunksQueueUp) {
  Window window;
  Time now = 1s;
  for (int i = 0; i < 100; ++i) window.arrived(now += 1ms, 20ms, false, window.chunks());
  const std::size_t before = window.chunks();
  for (int i = 0; i < 2000; ++i) window.arrived(now += 1ms, 120ms, false, window.chunks());
  EXPECT_LT(window.chunks(), before / 2);
  EXPECT_GE(window.chunks(), 4U);
}

TEST(Window, LossByChanceDoesNotShrinkIt) {
  Window window;
  Time now = 1s;
  for (int i = 0; i < 2000; ++i)
    i % 20 == 0 ? window.lost(now) : window.arrived(now += 1ms, 20ms, false, window.chunks());
  EXPECT_GT(window.chunks(), 100U);
  for (int i = 0; i < 500; ++i)
    i % 2 == 0 ? window.lost(now) : window.arrived(now += 1ms, 20ms, false, window.chunks());
  EXPECT_LT(window.chunks(), 50U);
}

TEST(Window, WaitsLongerTheLongerNobodyAnswers) {
  Window window;
  window.arrived(1s, 10ms, false, 1);
  const Time timeout = window.timeout();
  window.silent();
  EXPECT_EQ(window.timeout(), 2 * timeout);
  for (int i = 0; i < 20; ++i) window.silent();
  EXPECT_EQ(window.timeout(), 1s);
  EXPECT_EQ(window.chunks(), 4U);
  window.arrived(30s, 10ms, true, 1);
  EXPECT_EQ(window.timeout(), timeout);
}

TEST(Window, OfAStreamStaysAsItIsAfterASilence) {
  Window window(Way::kStream);
  const std::size_t chunks = window.chunks();
  window.silent();
  EXPECT_EQ(window.chunks(), chunks);
}

}  // namespace
}  // namespace rds::transfer
