// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/wire/impaired_direction.hpp"

#include <gmock/gmock.h>

namespace rds::test {
namespace {

using namespace std::chrono_literals;
using Frame = ImpairedDirection::Frame;
using ::testing::ElementsAre;

constexpr std::uint32_t kSeed = 1;

TEST(ImpairedDirection, GivesFramesWhenTheyAreDue) {
  ImpairedDirection direction({.delay_ms = 20}, kSeed);
  EXPECT_EQ(direction.next_due(), std::nullopt);
  direction.push({1}, 0ms);
  direction.push({2}, 5ms);
  EXPECT_EQ(direction.next_due(), 20ms);
  EXPECT_EQ(direction.pop(19ms), std::nullopt);
  EXPECT_EQ(direction.pop(20ms), Frame{1});
  EXPECT_EQ(direction.next_due(), 25ms);
  EXPECT_EQ(direction.pop(30ms), Frame{2});
  EXPECT_EQ(direction.pop(30ms), std::nullopt);
}

TEST(ImpairedDirection, KeepsTheOrderOfArrivalWithoutJitter) {
  ImpairedDirection direction({}, kSeed);
  for (std::uint8_t i = 0; i < 5; ++i) direction.push({i}, 0ms);
  std::vector<int> order;
  while (const auto frame = direction.pop(0ms)) order.push_back(frame->front());
  EXPECT_THAT(order, ElementsAre(0, 1, 2, 3, 4));
}

TEST(ImpairedDirection, DelaysWithinTheJitter) {
  ImpairedDirection direction({.delay_ms = 20, .jitter_ms = 10}, kSeed);
  constexpr int kFrames = 1000;
  for (int i = 0; i < kFrames; ++i) direction.push({1}, 0ms);
  EXPECT_GE(direction.next_due().value(), 10ms);
  int early = 0;
  while (direction.pop(20ms)) ++early;
  EXPECT_NEAR(early, kFrames / 2, kFrames / 20);
  int late = 0;
  while (direction.pop(30ms)) ++late;
  EXPECT_EQ(early + late, kFrames);
}

TEST(ImpairedDirection, LosesTheShareItShould) {
  ImpairedDirection direction({.loss = 0.05}, kSeed);
  constexpr int kFrames = 10'000;
  for (int i = 0; i < kFrames; ++i) direction.push({1}, 0ms);
  int arrived = 0;
  while (direction.pop(0ms)) ++arrived;
  EXPECT_NEAR(arrived, 9500, 100);
}

}  // namespace
}  // namespace rds::test
