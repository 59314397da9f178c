// SPDX-License-Identifier: Apache-2.0
#include "common/service/process/deafness_watch.hpp"

#include <gtest/gtest.h>

namespace rds::service {
namespace {

constexpr double kLookS = 0.1;

/// Looks for so long while others are heard of, or not.
bool look_for(DeafnessWatch& watch, double seconds, bool hears_others) {
  bool is_deaf = false;
  for (double s = 0; s < seconds; s += kLookS) is_deaf = watch.look(hears_others, kLookS) || is_deaf;
  return is_deaf;
}

TEST(DeafnessWatch, SeesWhoHearsOfNobodyAfterAStop) {
  DeafnessWatch watch;
  EXPECT_FALSE(look_for(watch, 3, true));
  EXPECT_FALSE(watch.look(true, 10)) << "what had arrived is heard first";
  EXPECT_FALSE(look_for(watch, 5, true));
  EXPECT_FALSE(look_for(watch, 14, false));
  EXPECT_TRUE(look_for(watch, 2, false));
}

TEST(DeafnessWatch, SaysNothingOfWhoFindsTheOthersAgain) {
  DeafnessWatch watch;
  EXPECT_FALSE(look_for(watch, 3, true));
  EXPECT_FALSE(watch.look(false, 12));
  EXPECT_FALSE(look_for(watch, 15, false));
  EXPECT_FALSE(look_for(watch, 10, true));
  EXPECT_FALSE(look_for(watch, 60, false)) << "they have left since";
}

TEST(DeafnessWatch, SaysNothingOfWhoWasAlone) {
  DeafnessWatch watch;
  EXPECT_FALSE(look_for(watch, 3, false));
  EXPECT_FALSE(watch.look(false, 100));
  EXPECT_FALSE(look_for(watch, 60, false));
}

TEST(DeafnessWatch, SaysNothingWithoutAStop) {
  DeafnessWatch watch;
  EXPECT_FALSE(look_for(watch, 3, true));
  EXPECT_FALSE(look_for(watch, 100, false));
}

TEST(DeafnessWatch, OfTwoStopsTheSecondBeginsThePatienceAnew) {
  DeafnessWatch watch;
  EXPECT_FALSE(look_for(watch, 3, true));
  EXPECT_FALSE(watch.look(false, 10));
  EXPECT_FALSE(look_for(watch, 15, false));
  EXPECT_FALSE(watch.look(false, 10));
  EXPECT_FALSE(look_for(watch, 15, false));
  EXPECT_TRUE(look_for(watch, 6, false)) << "there were others before the first";
}

}  // namespace
}  // namespace rds::service
