// SPDX-License-Identifier: Apache-2.0
#include "common/time/stamp_watch.hpp"

#include <gmock/gmock.h>

namespace rds::time {
namespace {

using testing::ElementsAre;
using enum StampVerdict;

constexpr std::int64_t kMs = 1'000'000;

class StampWatchTest : public testing::Test {
 protected:
  /// @param stamps_ms  one after the other.
  std::vector<StampVerdict> take(const std::vector<std::int64_t>& stamps_ms) {
    std::vector<StampVerdict> verdicts;
    for (const std::int64_t ms : stamps_ms) verdicts.push_back(watch.take(ms * kMs));
    return verdicts;
  }
  StampWatch watch;
};

TEST_F(StampWatchTest, TimeGoesOnThroughGaps) {
  EXPECT_THAT(take({5000, 5033, 7033, 9034, 19034}), ElementsAre(kOn, kOn, kOn, kGap, kGap));
}

TEST_F(StampWatchTest, WhatIsRepeatedOrOvertakenIsDroppedAndTimeStays) {
  EXPECT_THAT(take({5000, 5033, 5033, 5000, 4533, 5066}), ElementsAre(kOn, kOn, kLate, kLate, kLate, kOn));
}

TEST_F(StampWatchTest, ALoneStampOfAnotherTimeLeavesNoTrace) {
  EXPECT_THAT(take({5000, 1005033, 5066, 5100, 1005133, 5166}),
              ElementsAre(kOn, kDoubt, kOn, kOn, kDoubt, kOn));
  EXPECT_THAT(take({4100, 5233, 5266}), ElementsAre(kDoubt, kOn, kOn));
}

TEST_F(StampWatchTest, AStampThatGoesOnFromADoubtedOneIsABreak) {
  EXPECT_THAT(take({5000, 1005033, 1005066, 1005100}), ElementsAre(kOn, kDoubt, kBreak, kOn));
  EXPECT_EQ(watch.break_ns(), 1'000'066 * kMs);
  EXPECT_THAT(take({5133, 5166, 5200}), ElementsAre(kDoubt, kBreak, kOn));
  EXPECT_EQ(watch.break_ns(), -999'934 * kMs);
}

TEST_F(StampWatchTest, ARecordingThatBeginsAgainBreaksEachTime) {
  for (int lap = 0; lap < 3; ++lap)
    EXPECT_THAT(take({5000, 5033, 7000}), ElementsAre(lap == 0 ? kOn : kDoubt, lap == 0 ? kOn : kBreak, kOn));
}

TEST_F(StampWatchTest, ACameraSlowerThanAnyLimitIsNotDroppedForEver) {
  EXPECT_THAT(take({0, 20'000, 40'000, 60'000, 80'000}), ElementsAre(kOn, kDoubt, kBreak, kDoubt, kBreak));
}

TEST_F(StampWatchTest, StampsWithoutAnyOrderAreDropped) {
  EXPECT_THAT(take({5000, 900'000, 300'000, 100'000, 50'000, 5033}),
              ElementsAre(kOn, kDoubt, kDoubt, kDoubt, kDoubt, kOn));
}

TEST_F(StampWatchTest, RepeatingADoubtedStampProvesNothing) {
  EXPECT_THAT(take({5000, 1005033, 1005033, 1005033, 5066}), ElementsAre(kOn, kDoubt, kLate, kLate, kOn));
}

TEST_F(StampWatchTest, BreaksAtOnceWhereNothingIsDoubted) {
  watch = StampWatch(false);
  EXPECT_THAT(take({5000, 25'000, 25'033, 5000, 5000}), ElementsAre(kOn, kBreak, kOn, kBreak, kLate));
}

TEST_F(StampWatchTest, TheFirstStampMayBeTheWrongOne) {
  EXPECT_THAT(take({1005000, 5033, 5066, 5100}), ElementsAre(kOn, kDoubt, kBreak, kOn));
}

TEST_F(StampWatchTest, BearsTheLargestStampsThereAre) {
  constexpr std::int64_t kLargest = std::int64_t{1} << 31;  // s
  EXPECT_EQ(watch.take(-kLargest * 1000 * kMs), kOn);
  EXPECT_EQ(watch.take((kLargest - 1) * 1000 * kMs), kDoubt);
  EXPECT_EQ(watch.take(kLargest * 1000 * kMs), kBreak);
}

}  // namespace
}  // namespace rds::time
