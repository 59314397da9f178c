// SPDX-License-Identifier: Apache-2.0
#include "common/service/process/hang_watch.hpp"

#include <gtest/gtest.h>

namespace rds::service {
namespace {

constexpr double kLookS = 0.1;

/// Looks at a thread that says nothing from `from_s` to `to_s`.
bool look_through(HangWatch& watch, double from_s, double to_s) {
  bool hangs = false;
  for (double silent_s = from_s; silent_s <= to_s; silent_s += kLookS) hangs = watch.look(silent_s, kLookS);
  return hangs;
}

TEST(HangWatch, SeesSilenceBeyondTheLimit) {
  HangWatch watch(5);
  EXPECT_FALSE(look_through(watch, 0, 4.9));
  EXPECT_TRUE(look_through(watch, 4.9, 5.5));
}

TEST(HangWatch, BeginsAnewWithEachSignOfLife) {
  HangWatch watch(5);
  EXPECT_FALSE(look_through(watch, 0, 4.5));
  EXPECT_FALSE(look_through(watch, 0, 4.5));
}

TEST(HangWatch, TimeInWhichTheWholeProcessWasStoppedDoesNotCount) {
  HangWatch watch(5);
  EXPECT_FALSE(look_through(watch, 0, 1));
  EXPECT_FALSE(watch.look(61, 60));
  EXPECT_FALSE(look_through(watch, 61, 63));
  EXPECT_TRUE(look_through(watch, 63, 66)) << "but it still says nothing";
}

TEST(HangWatch, AShortLimitHoldsForAThreadThatSpeaksOnceInASecond) {
  HangWatch watch(2);
  EXPECT_FALSE(look_through(watch, 0, 1)) << "it was about to speak";
  EXPECT_FALSE(watch.look(5, 4)) << "when all were stopped";
  EXPECT_FALSE(look_through(watch, 5.1, 5.5));
}

TEST(HangWatch, WithoutALimitNothingHangs) {
  HangWatch watch(0);
  EXPECT_FALSE(look_through(watch, 0, 100));
}

}  // namespace
}  // namespace rds::service
