// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/epoch_follower.hpp"

#include <gmock/gmock.h>

namespace rds::mapper {
namespace {

using namespace std::chrono_literals;
using service::Rejection;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uint64_t kTracker = 7;
constexpr std::uint64_t kEpoch = 42;

EpochFollower::Images keyframe(std::uint64_t epoch, std::uint64_t id) {
  rds_msgs::msg::KeyFrameImages message;
  message.instance(kTracker);
  message.map_epoch(epoch);
  message.keyframe_id(id);
  return std::make_shared<const rds_msgs::msg::KeyFrameImages>(message);
}

EpochFollower::Poses poses(std::uint64_t epoch) {
  rds_msgs::msg::KeyFramePoses message;
  message.instance(kTracker);
  message.map_epoch(epoch);
  return std::make_shared<const rds_msgs::msg::KeyFramePoses>(message);
}

class Epochs : public ::testing::Test {
 protected:
  /// Why a message of the tracker is not used.
  std::optional<Rejection> hear(std::uint64_t epoch, std::uint64_t instance = kTracker) {
    const auto refusal = epochs_.hear_tracker(instance, epoch, current_, now_);
    return refusal ? std::optional(refusal->code) : std::nullopt;
  }
  void begin(std::uint64_t epoch) {
    epochs_.begin(current_, now_);
    current_ = epoch;
  }

  std::uint64_t followed_ = kTracker;
  EpochFollower epochs_{[this](std::uint64_t instance, bool) { return instance == followed_; }};
  std::uint64_t current_ = kEpoch;
  EpochFollower::Clock::time_point now_{1000s};
};

TEST_F(Epochs, AnotherTrackerIsForeign) {
  EXPECT_EQ(hear(kEpoch), std::nullopt);
  EXPECT_EQ(hear(kEpoch, kTracker + 1), Rejection::kForeign);
}

TEST_F(Epochs, OneThatIsOverIsRefusedWhileItsSuccessorIsHeard) {
  ASSERT_EQ(hear(kEpoch), std::nullopt);
  begin(kEpoch + 1);
  EXPECT_EQ(hear(kEpoch), Rejection::kOutdated);
  EXPECT_EQ(hear(kEpoch + 2), std::nullopt) << "it may begin";
  now_ += 2s;
  EXPECT_EQ(hear(kEpoch + 1), std::nullopt);
  now_ += 2s;
  EXPECT_EQ(hear(kEpoch), Rejection::kOutdated);
  now_ += 2s;
  EXPECT_EQ(hear(kEpoch), std::nullopt) << "the one after it is silent, it goes on";
}

TEST_F(Epochs, OfAnotherTrackerNoneIsOver) {
  ASSERT_EQ(hear(kEpoch), std::nullopt);
  begin(kEpoch + 1);
  followed_ = kTracker + 1;
  EXPECT_EQ(hear(kEpoch, kTracker + 1), std::nullopt);
}

TEST_F(Epochs, TheNextOneBeginsWithItsSecondKeyframe) {
  const auto first = keyframe(kEpoch + 1, 0);
  const auto second = keyframe(kEpoch + 1, 1);
  EXPECT_THAT(epochs_.confirm(first), IsEmpty());
  EXPECT_THAT(epochs_.confirm(first), IsEmpty()) << "the same message twice";
  EXPECT_THAT(epochs_.confirm(second), ElementsAre(first, second));
}

TEST_F(Epochs, ASpoiledMessageBeginsNone) {
  EXPECT_THAT(epochs_.confirm(keyframe(kEpoch + 1, 0)), IsEmpty());
  ASSERT_EQ(hear(kEpoch), std::nullopt);  // the current one goes on
  EXPECT_THAT(epochs_.confirm(keyframe(kEpoch + 1, 1)), IsEmpty());
}

TEST_F(Epochs, PosesConfirmTheFirstKeyframe) {
  EXPECT_EQ(epochs_.confirm(poses(kEpoch + 1)), nullptr) << "they begin none themselves";
  const auto first = keyframe(kEpoch + 2, 0);
  EXPECT_THAT(epochs_.confirm(first), IsEmpty());
  EXPECT_EQ(epochs_.confirm(poses(kEpoch + 2)), first);
}

TEST_F(Epochs, PosesWaitForTheirEpoch) {
  const auto all = poses(kEpoch + 1);
  const auto changes = poses(kEpoch + 1);
  epochs_.keep(all);
  epochs_.keep(changes);
  EXPECT_THAT(epochs_.begin(kEpoch, now_), ElementsAre(all, changes));
  EXPECT_THAT(epochs_.begin(kEpoch + 1, now_), IsEmpty());
}

}  // namespace
}  // namespace rds::mapper
