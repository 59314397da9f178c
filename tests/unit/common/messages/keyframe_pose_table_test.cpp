// SPDX-License-Identifier: Apache-2.0
#include "common/messages/keyframe_pose_table.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "common/messages/keyframe_conversions.hpp"

namespace rds::messages {
namespace {

using geometry::KeyframePose;
using Message = rds_msgs::msg::KeyFramePoses;

KeyframePose pose(std::uint64_t id, double x_m) {
  KeyframePose pose{id, static_cast<std::int64_t>(id) * 1000, geometry::Pose::Identity()};
  pose.map_from_camera.translation().x() = x_m;
  return pose;
}

class KeyframePosesOnTheWay : public ::testing::Test {
 protected:
  Message tell(const std::vector<KeyframePose>& poses, bool all = false) {
    Message message;
    message.instance(7);
    message.map_epoch(42);
    append_poses(changes_.next(poses, all, message), message);
    return message;
  }
  bool hear(const Message& message) { return table_.take(message, to_keyframe_poses(message).value()); }
  [[nodiscard]] std::vector<double> heard() const {
    std::vector<double> x;
    for (const KeyframePose& pose : table_.poses()) x.push_back(pose.map_from_camera.translation().x());
    return x;
  }

  KeyframePoseChanges changes_;
  KeyframePoseTable table_;
};

TEST_F(KeyframePosesOnTheWay, CarryWhatIsNewOrHasMoved) {
  ASSERT_TRUE(hear(tell({pose(0, 0), pose(1, 1)})));
  const Message second = tell({pose(0, 0), pose(1, 1.5), pose(3, 3)});
  EXPECT_EQ(second.keyframe_ids(), (std::vector<std::uint64_t>{1, 3}));
  ASSERT_TRUE(hear(second));
  EXPECT_EQ(heard(), (std::vector<double>{0, 1.5, 3}));
  EXPECT_TRUE(tell({pose(0, 0), pose(1, 1.5), pose(3, 3)}).keyframe_ids().empty());
}

TEST_F(KeyframePosesOnTheWay, WhatHardlyMovesIsToldWhenThatAddsUpOrExactly) {
  ASSERT_TRUE(hear(tell({pose(0, 0), pose(1, 1)})));
  EXPECT_TRUE(tell({pose(0, 0), pose(1, 1.0006)}).keyframe_ids().empty());
  EXPECT_EQ(tell({pose(0, 0), pose(1, 1.0012)}).keyframe_ids(), (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(tell({pose(0, 0), pose(1, 1.0013)}, true).keyframe_ids().size(), 2U);
}

TEST_F(KeyframePosesOnTheWay, AMissedMessageIsNoticedUntilAllAreTold) {
  ASSERT_TRUE(hear(tell({pose(0, 0)})));
  (void)tell({pose(0, 1)});  // lost
  EXPECT_FALSE(hear(tell({pose(0, 1), pose(1, 1)})));
  EXPECT_FALSE(hear(tell({pose(0, 1), pose(1, 2)})));
  EXPECT_TRUE(hear(tell({pose(0, 1), pose(1, 2)}, true)));
  EXPECT_EQ(heard(), (std::vector<double>{1, 2}));
}

TEST_F(KeyframePosesOnTheWay, ALateReaderIsToldAllAndOthersGoOn) {
  ASSERT_TRUE(hear(tell({pose(0, 0)})));
  const Message all = tell({pose(0, 0), pose(1, 1)}, true);
  KeyframePoseTable late;
  EXPECT_TRUE(late.take(all, to_keyframe_poses(all).value()));
  EXPECT_TRUE(hear(all));
  EXPECT_EQ(late.poses().size(), table_.poses().size());
}

TEST_F(KeyframePosesOnTheWay, AreAsManyAMessageHoweverLongTheRunIs) {
  std::vector<KeyframePose> poses;
  std::size_t told = 0;
  constexpr std::size_t kKeyframes = 20'000;
  for (std::uint64_t id = 0; id < kKeyframes; ++id) {
    poses.push_back(pose(id, static_cast<double>(id)));
    told += tell(poses).keyframe_ids().size();
  }
  EXPECT_LT(static_cast<double>(told) / kKeyframes, 40.0);  // 10 000 with all poses in each
}

TEST_F(KeyframePosesOnTheWay, AnotherMapBeginsWithAll) {
  ASSERT_TRUE(hear(tell({pose(0, 0), pose(1, 1)})));
  changes_.clear();
  ASSERT_TRUE(hear(tell({pose(0, 5)})));
  EXPECT_EQ(heard(), (std::vector<double>{5}));
}

TEST(KeyframePosesOfALoop, CarryItsMatches) {
  Message message;
  append_loops(std::vector<geometry::LoopMatch>{{7, 3, pose(0, 0.5).map_from_camera},
                                                {9, 2, pose(0, 1).map_from_camera}},
               message);
  EXPECT_EQ(fault_of(message), "");
  const auto loops = to_loops(message);
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_EQ(loops[1].later, 9U);
  EXPECT_EQ(loops[1].earlier, 2U);
  EXPECT_TRUE(loops[1].earlier_from_later.isApprox(pose(0, 1).map_from_camera));
}

TEST(KeyframePosesFault, IsWhatNoTrackerWrites) {
  Message good;
  append_poses(std::vector{pose(3, 0), pose(7, 1)}, good);
  append_loops(std::vector<geometry::LoopMatch>{{7, 3, geometry::Pose::Identity()}}, good);
  EXPECT_EQ(fault_of(good), "");
  Message bad = good;
  bad.keyframe_ids({7, 7});
  EXPECT_NE(fault_of(bad), "") << "one keyframe twice";
  bad = good;
  bad.stamps({0, std::numeric_limits<std::int64_t>::min()});
  EXPECT_NE(fault_of(bad), "");
  bad = good;
  bad.poses()[0] = 1e30;
  EXPECT_NE(fault_of(bad), "");
  bad = good;
  bad.loops().pop_back();
  EXPECT_NE(fault_of(bad), "");
  bad = good;
  bad.loop_poses()[6] = 0;
  EXPECT_NE(fault_of(bad), "");
}

}  // namespace
}  // namespace rds::messages
