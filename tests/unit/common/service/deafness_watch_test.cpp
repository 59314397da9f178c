// SPDX-License-Identifier: Apache-2.0
#include "common/service/process/deafness_watch.hpp"

#include <gtest/gtest.h>

namespace rds::service {
namespace {

constexpr double kLookS = 0.1;

/// Looks for so long while so many others are heard of.
bool look_for(DeafnessWatch& watch, double seconds, std::size_t others) {
  bool is_deaf = false;
  for (double s = 0; s < seconds; s += kLookS) is_deaf = watch.look(others, kLookS) || is_deaf;
  return is_deaf;
}

TEST(DeafnessWatch, SeesWhoHearsOfNobodyAfterAStop) {
  DeafnessWatch watch;
  EXPECT_FALSE(look_for(watch, 3, 4));
  EXPECT_FALSE(watch.look(4, 10)) << "what had arrived is heard first";
  EXPECT_FALSE(look_for(watch, 5, 4));
  EXPECT_FALSE(look_for(watch, 14, 0));
  EXPECT_TRUE(look_for(watch, 2, 0));
}

TEST(DeafnessWatch, SaysNothingOfWhoFindsTheOthersAgain) {
  DeafnessWatch watch;
  EXPECT_FALSE(look_for(watch, 3, 4));
  EXPECT_FALSE(watch.look(0, 12));
  EXPECT_FALSE(look_for(watch, 15, 0));
  EXPECT_FALSE(look_for(watch, 10, 1));
  EXPECT_FALSE(look_for(watch, 60, 0)) << "they have left since";
}

TEST(DeafnessWatch, SaysNothingOfWhoWasAlone) {
  DeafnessWatch watch;
  EXPECT_FALSE(look_for(watch, 3, 0));
  EXPECT_FALSE(watch.look(0, 100));
  EXPECT_FALSE(look_for(watch, 60, 0));
}

TEST(DeafnessWatch, SaysNothingWithoutAStop) {
  DeafnessWatch watch;
  EXPECT_FALSE(look_for(watch, 3, 4));
  EXPECT_FALSE(look_for(watch, 100, 0));
}

TEST(DeafnessWatch, OfTwoStopsTheSecondBeginsThePatienceAnew) {
  DeafnessWatch watch;
  EXPECT_FALSE(look_for(watch, 3, 4));
  EXPECT_FALSE(watch.look(0, 10));
  EXPECT_FALSE(look_for(watch, 15, 0));
  EXPECT_FALSE(watch.look(0, 10));
  EXPECT_FALSE(look_for(watch, 15, 0));
  EXPECT_TRUE(look_for(watch, 6, 0)) << "there were others before the first";
}

}  // namespace
}  // namespace rds::service
