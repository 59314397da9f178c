// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/keyframe_answers.hpp"

#include <gtest/gtest.h>

#include "common/messages/conversions.hpp"
#include "tests/support/test_domain.hpp"

namespace rds::tracker {
namespace {

constexpr std::uint64_t kEpoch = 77;

class Answers : public ::testing::Test {
 protected:
  static KeyframeAnswers::Boxes boxes_of(std::int64_t stamp_ns) {
    auto boxes = std::make_shared<vision_msgs::msg::Detection3DArray>();
    boxes->header(messages::make_header(stamp_ns, "map"));
    return boxes;
  }
  static KeyframeAnswers::Poses poses_of(std::uint64_t keyframe, std::uint64_t map_epoch = kEpoch) {
    auto poses = std::make_shared<rds_msgs::msg::KeyFramePoses>();
    poses->instance(1);
    poses->map_epoch(map_epoch);
    poses->answered_keyframe_id(keyframe);
    return poses;
  }
  KeyframeAnswers answers(bool lockstep, double timeout_s = 30) {
    return KeyframeAnswers(context, mailbox, {.enabled = lockstep, .timeout_s = timeout_s}, 0);
  }

  std::unique_ptr<bus::Participant> participant = bus::Participant::create(
      {.domain = test::test_domain(), .node_name = "tracker", .loopback_only = true});
  service::Diagnostics diagnostics;
  service::ServiceContext context{"tracker", *participant, diagnostics};
  concurrency::Mailbox mailbox;
};

TEST_F(Answers, InLockstepBoxesTakeEffectAtTheirFrame) {
  KeyframeAnswers lockstep = answers(true);
  lockstep.ask_for_boxes(100, {3, geometry::Pose::Identity(), {}}, 5);
  lockstep.push(boxes_of(100));
  lockstep.sort_in(kEpoch);
  EXPECT_TRUE(lockstep.take_boxes(5 + LockstepConfig{}.detection_latency_frames - 1).empty());
  EXPECT_EQ(lockstep.take_boxes(5 + LockstepConfig{}.detection_latency_frames).size(), 1U);
  EXPECT_TRUE(lockstep.empty());
}

TEST_F(Answers, OtherwiseAtOnce) {
  KeyframeAnswers live = answers(false);
  live.ask_for_poses(3, 5);
  live.push(poses_of(3));
  live.sort_in(kEpoch);
  EXPECT_EQ(live.take_poses(5).size(), 1U);
  EXPECT_EQ(diagnostics.rejected(), 0U);
}

TEST_F(Answers, BoxesBelongToTheirKeyframeOnce) {
  KeyframeAnswers live = answers(false);
  live.ask_for_boxes(100, {3, geometry::Pose::Identity(), {}}, 5);
  const auto snapshot = live.take_snapshot(100);
  ASSERT_TRUE(snapshot);
  EXPECT_EQ(snapshot->id, 3U);
  EXPECT_FALSE(live.take_snapshot(100));
  EXPECT_FALSE(live.take_snapshot(101));
}

TEST_F(Answers, WhatNobodyAskedForAndWhatIsOfAnotherEpochIsRefused) {
  KeyframeAnswers live = answers(false);
  live.push(boxes_of(100));
  live.ask_for_poses(3, 5);
  live.push(poses_of(3, kEpoch + 1));
  live.sort_in(kEpoch);
  EXPECT_EQ(diagnostics.rejected(), 2U);
  EXPECT_TRUE(live.take_boxes(5).empty());
  EXPECT_TRUE(live.take_poses(5).empty());
}

TEST_F(Answers, LocalMappingIsWaitedFor) {
  KeyframeAnswers lockstep = answers(true);
  LocalMappingJob job;
  job.keyframe = 3;
  lockstep.ask_for_mapping(job, 0);
  EXPECT_TRUE(lockstep.is_mapping());
  int beats = 0;
  lockstep.await(KeyframeAnswers::kMappingAfter, kEpoch, {}, [&] { ++beats; });
  const auto results = lockstep.take_mappings(KeyframeAnswers::kMappingAfter);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results.front().keyframe, 3U);
  EXPECT_GE(beats, 1);
  EXPECT_FALSE(lockstep.is_mapping());
}

TEST_F(Answers, ANewAdjustmentStopsTheOneBefore) {
  KeyframeAnswers lockstep = answers(true);
  LocalMappingJob job;
  job.revision = 1;
  lockstep.ask_for_adjustment(job, 0);
  job.revision = 2;
  lockstep.ask_for_adjustment(job, 7);
  lockstep.await(KeyframeAnswers::kAdjustmentAfter + 7, kEpoch, {}, [] {});
  const auto results = lockstep.take_adjustments(KeyframeAnswers::kAdjustmentAfter + 7);
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results.front().revision, 2U);
  EXPECT_EQ(diagnostics.counter("lockstep timeouts").load(), 0U);
  EXPECT_TRUE(lockstep.empty());
}

TEST_F(Answers, AFrameGoesOnWithoutAnAnswerThatDoesNotCome) {
  KeyframeAnswers lockstep = answers(true, 0.05);
  lockstep.ask_for_poses(3, 0);
  lockstep.await(KeyframeAnswers::kPosesAfter - 1, kEpoch, {}, [] {});
  EXPECT_EQ(diagnostics.counter("lockstep timeouts").load(), 0U);
  lockstep.await(KeyframeAnswers::kPosesAfter, kEpoch, {}, [] {});
  EXPECT_EQ(diagnostics.counter("lockstep timeouts").load(), 1U);
  EXPECT_TRUE(lockstep.take_poses(KeyframeAnswers::kPosesAfter).empty());
  EXPECT_TRUE(lockstep.empty());
}

}  // namespace
}  // namespace rds::tracker
