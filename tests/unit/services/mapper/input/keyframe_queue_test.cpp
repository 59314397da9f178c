// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/keyframe_queue.hpp"

#include <gtest/gtest.h>

#include "common/messages/conversions.hpp"

namespace rds::mapper {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

KeyframeQueue::Images keyframe(std::uint64_t id, std::int64_t stamp_ns) {
  rds_msgs::msg::KeyFrameImages message;
  message.keyframe_id(id);
  message.header(messages::make_header(stamp_ns, "camera"));
  return std::make_shared<const rds_msgs::msg::KeyFrameImages>(message);
}

KeyframeQueue::Boxes boxes(std::int64_t stamp_ns) {
  vision_msgs::msg::Detection3DArray message;
  message.header(messages::make_header(stamp_ns, "map"));
  return std::make_shared<const vision_msgs::msg::Detection3DArray>(message);
}

TEST(KeyframeQueue, AKeyframeWaitsForItsBoxes) {
  KeyframeQueue queue(5, {});
  EXPECT_FALSE(queue.is_ready());
  queue.add(keyframe(3, 30 * kSecond));
  EXPECT_FALSE(queue.is_ready());
  const auto its_boxes = boxes(30 * kSecond);
  EXPECT_EQ(queue.add(its_boxes), nullptr);
  ASSERT_TRUE(queue.is_ready());
  EXPECT_EQ(queue.take_oldest().boxes, its_boxes);
  EXPECT_TRUE(queue.empty());
}

TEST(KeyframeQueue, BoxesMayComeFirst) {
  KeyframeQueue queue(5, {});
  queue.add(boxes(30 * kSecond));
  queue.add(keyframe(3, 30 * kSecond));
  EXPECT_TRUE(queue.is_ready());
  queue.forget_boxes_before(31 * kSecond);
  EXPECT_FALSE(queue.is_ready());
}

TEST(KeyframeQueue, WithoutBoxesItGoesOnWhenANewerKeyframeHasCome) {
  KeyframeQueue queue(5, {.timeout_s = 1});
  queue.add(keyframe(3, 30 * kSecond));
  queue.add(keyframe(4, 31 * kSecond));
  EXPECT_FALSE(queue.is_ready());
  queue.add(keyframe(5, 31 * kSecond + 1));
  ASSERT_TRUE(queue.is_ready());
  EXPECT_EQ(queue.take_oldest().boxes, nullptr);
}

TEST(KeyframeQueue, WhatWasMissedWaitsForNothingInWhateverOrderItComes) {
  KeyframeQueue queue(20, {.timeout_s = 1});
  queue.add(keyframe(50, 50 * kSecond));
  for (std::uint64_t id = 40; id > 20; --id) {
    queue.add(keyframe(id, static_cast<std::int64_t>(id) * kSecond / 5));
    ASSERT_TRUE(queue.is_ready()) << id;
    EXPECT_EQ(queue.take_oldest().images->keyframe_id(), id);
  }
  EXPECT_FALSE(queue.is_ready()) << "the newest's own boxes may come";
}

TEST(KeyframeQueue, WhereNoKeyframeFollowsItGoesOnAfterAWhile) {
  const auto now = KeyframeQueue::Clock::now();
  KeyframeQueue queue(5, {});
  queue.add(keyframe(3, 30 * kSecond), now);
  EXPECT_FALSE(queue.is_ready(now + KeyframeQueue::kLongestWait));
  EXPECT_TRUE(queue.is_ready(now + KeyframeQueue::kLongestWait + std::chrono::milliseconds(1)));
}

TEST(KeyframeQueue, InLockstepOnlyLaterBoxesTellThatItsOwnAreLost) {
  KeyframeQueue queue(5, {.lockstep = true, .timeout_s = 1});
  queue.add(keyframe(3, 30 * kSecond));
  queue.add(keyframe(4, 40 * kSecond));
  EXPECT_FALSE(queue.is_ready());
  queue.add(boxes(40 * kSecond));
  EXPECT_TRUE(queue.is_ready());
}

TEST(KeyframeQueue, WithoutADetectorNothingWaits) {
  KeyframeQueue queue(5, {.expected = false});
  queue.add(keyframe(3, 30 * kSecond));
  EXPECT_TRUE(queue.is_ready());
}

TEST(KeyframeQueue, TheOldestIsDroppedAndCounted) {
  KeyframeQueue queue(2, {.expected = false});
  for (const std::uint64_t id : {5U, 3U, 4U})
    queue.add(keyframe(id, static_cast<std::int64_t>(id) * kSecond));
  EXPECT_EQ(queue.size(), 2U);
  EXPECT_EQ(queue.dropped(), 1U);
  EXPECT_EQ(queue.take_oldest().images->keyframe_id(), 4U);
}

TEST(KeyframeQueue, BoxesOfAnIntegratedKeyframeAreLate) {
  KeyframeQueue queue(5, {});
  queue.note_integrated({3, 30 * kSecond, geometry::Pose::Identity(), {}});
  queue.add(keyframe(3, 30 * kSecond));
  EXPECT_TRUE(queue.empty()) << "it is in the map";
  const IntegratedKeyframe* late_for = queue.add(boxes(30 * kSecond));
  ASSERT_NE(late_for, nullptr);
  EXPECT_EQ(late_for->id, 3U);
  queue.add(keyframe(9, 30 * kSecond));  // a recording that is played again
  EXPECT_EQ(queue.add(boxes(30 * kSecond)), nullptr);
  EXPECT_TRUE(queue.is_ready());
  queue.forget_keyframes();
  EXPECT_EQ(queue.add(boxes(30 * kSecond)), nullptr) << "another map";
}

TEST(KeyframeQueue, BoxesMayComeFirstInARecordingThatIsPlayedAgain) {
  KeyframeQueue queue(5, {});
  queue.note_integrated({3, 30 * kSecond, geometry::Pose::Identity(), {}, true});
  const auto of_second_lap = boxes(30 * kSecond);
  EXPECT_EQ(queue.add(of_second_lap), nullptr);
  queue.add(keyframe(9, 30 * kSecond));
  ASSERT_TRUE(queue.is_ready());
  EXPECT_EQ(queue.take_oldest().boxes, of_second_lap);
}

TEST(KeyframeQueue, LateBoxesAreOfTheirKeyframeOnce) {
  KeyframeQueue queue(5, {});
  queue.note_integrated({3, 30 * kSecond, geometry::Pose::Identity(), {}});
  EXPECT_NE(queue.add(boxes(30 * kSecond)), nullptr);
  EXPECT_EQ(queue.add(boxes(30 * kSecond)), nullptr) << "of the next lap";
}

}  // namespace
}  // namespace rds::mapper
