// SPDX-License-Identifier: Apache-2.0
#include "common/time/continuous_time.hpp"

#include <gtest/gtest.h>

namespace rds::time {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(ContinuousTime, IsTheStampsWhileTheyGoOn) {
  ContinuousTime time;
  for (const std::int64_t s : {100, 101, 150, 3000}) {
    EXPECT_EQ(time.at(s * kSecond).time_ns, s * kSecond);
    EXPECT_EQ(time.go_to(s * kSecond).time_ns, s * kSecond);
    EXPECT_EQ(time.at(s * kSecond).time_ns, s * kSecond);
  }
}

TEST(ContinuousTime, GoesOnWhereStampsGoBack) {
  ContinuousTime time;
  time.go_to(1000 * kSecond);
  EXPECT_TRUE(time.at(5 * kSecond).went_back);
  const auto back = time.go_to(5 * kSecond);
  EXPECT_TRUE(back.went_back);
  EXPECT_EQ(back.time_ns, 1000 * kSecond + ContinuousTime::kUnknownNs);
  const auto next = time.go_to(6 * kSecond);
  EXPECT_FALSE(next.went_back);
  EXPECT_EQ(next.time_ns, back.time_ns + kSecond);
  EXPECT_EQ(time.go_to(3 * kSecond).time_ns, next.time_ns + ContinuousTime::kUnknownNs);
}

TEST(ContinuousTime, ALateStampHasItsOwnEarlierTimeAndMovesNothing) {
  ContinuousTime time;
  time.go_to(10 * kSecond);
  time.go_to(5 * kSecond);
  const std::int64_t newest = time.go_to(6 * kSecond).time_ns;
  for (int i = 0; i < 3; ++i) {
    const auto late = time.go_to(6 * kSecond - kSecond / 4);
    EXPECT_FALSE(late.went_back);
    EXPECT_EQ(late.time_ns, newest - kSecond / 4);
  }
  EXPECT_EQ(time.go_to(7 * kSecond).time_ns, newest + kSecond);
}

TEST(ContinuousTime, NeverOverflowsByStampsThatJump) {
  constexpr std::int64_t kLargest = ((std::int64_t{1} << 31) - 1) * kSecond;
  ContinuousTime time;
  std::int64_t last = time.go_to(0).time_ns;
  for (int i = 0; i < 100; ++i) {
    const std::int64_t ahead = time.go_to(kLargest).time_ns;
    EXPECT_EQ(ahead, last + ContinuousTime::kLongestNs);
    last = time.go_to(-kLargest).time_ns;
    EXPECT_EQ(last, ahead + ContinuousTime::kUnknownNs);
  }
}

}  // namespace
}  // namespace rds::time
