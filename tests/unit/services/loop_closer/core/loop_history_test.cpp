// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/loop_history.hpp"

#include <gmock/gmock.h>

namespace rds::loop_closer {
namespace {

LoopDetection asking_for(std::size_t query, double shift_m) {
  LoopDetection detection;
  detection.query = query;
  detection.correction.translation().x() = shift_m;
  return detection;
}

TEST(LoopHistory, AnswersOnceThreeKeyframesAskForTheSameCorrection) {
  LoopHistory history;
  EXPECT_TRUE(history.add(asking_for(10, 0.30)).empty());
  EXPECT_TRUE(history.add(asking_for(11, 0.32)).empty());
  EXPECT_EQ(history.add(asking_for(12, 0.29)).size(), 3U);
}

TEST(LoopHistory, DoesNotCountOneKeyframeTwice) {
  LoopHistory history;
  EXPECT_TRUE(history.add(asking_for(10, 0.3)).empty());
  EXPECT_TRUE(history.add(asking_for(10, 0.3)).empty());
  EXPECT_TRUE(history.add(asking_for(10, 0.3)).empty());
}

TEST(LoopHistory, DoesNotCountCorrectionsThatDisagree) {
  LoopHistory history;
  EXPECT_TRUE(history.add(asking_for(10, 0.3)).empty());
  EXPECT_TRUE(history.add(asking_for(11, -0.5)).empty());
  EXPECT_TRUE(history.add(asking_for(12, 0.9)).empty());
}

TEST(LoopHistory, ForgetsOldDetections) {
  LoopHistory history;
  EXPECT_TRUE(history.add(asking_for(10, 0.3)).empty());
  EXPECT_TRUE(history.add(asking_for(20, 0.3)).empty());
  EXPECT_TRUE(history.add(asking_for(30, 0.3)).empty());
}

}  // namespace
}  // namespace rds::loop_closer
