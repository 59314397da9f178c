// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/robot/sensor_wait.hpp"

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

const auto kJoined = [] { return true; };
const auto kApart = [] { return false; };

TEST(SensorWait, IsOverWhenTheFramesTimeIsReached) {
  SensorWait wait;
  EXPECT_TRUE(wait.is_due(100, kJoined)) << "nothing has come";
  wait.take(99);
  EXPECT_TRUE(wait.is_due(100, kJoined));
  wait.take(100);
  EXPECT_FALSE(wait.is_due(100, kJoined));
  EXPECT_TRUE(wait.is_due(101, kJoined)) << "the next frame waits again";
}

TEST(SensorWait, IsForTheTransformToo) {
  SensorWait wait;
  wait.take(100);
  EXPECT_TRUE(wait.is_due(100, kApart));
  wait.give_up(100);
  EXPECT_FALSE(wait.is_due(100, kApart));
  wait.take(200);
  EXPECT_FALSE(wait.is_due(200, kApart)) << "not once per frame";
  EXPECT_TRUE(wait.is_due(300, kApart)) << "measurements are waited for all the same";
}

TEST(SensorWait, InVainIsNotRepeatedBeforeSomethingIsNew) {
  SensorWait wait;
  wait.give_up(100);
  EXPECT_FALSE(wait.is_due(133, kJoined)) << "a sensor that is not there";
  wait.take(120);
  EXPECT_TRUE(wait.is_due(133, kJoined));
  wait.give_up(133);
  EXPECT_FALSE(wait.is_due(166, kJoined)) << "one that has ended";
}

}  // namespace
}  // namespace rds::tracker
