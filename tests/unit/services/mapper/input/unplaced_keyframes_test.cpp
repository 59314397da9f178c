// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/unplaced_keyframes.hpp"

#include <gmock/gmock.h>

namespace rds::mapper {
namespace {

using testing::ElementsAre;

KeyframeQueue::Entry keyframe(std::uint64_t id, std::uint32_t submap) {
  rds_msgs::msg::KeyFrameImages images;
  images.keyframe_id(id);
  images.submap(submap);
  return {std::make_shared<const rds_msgs::msg::KeyFrameImages>(images), nullptr};
}

/// What the tracker has told of these keyframes.
void tell(KnownPoses& poses, std::uint64_t revision, const std::vector<std::uint64_t>& ids) {
  KnownPoses::Message message;
  message.revision(revision);
  std::vector<geometry::KeyframePose> told;
  for (const std::uint64_t id : ids) told.push_back({id, 0, geometry::Pose::Identity()});
  poses.take(message, told);
}

std::vector<std::uint64_t> take_all(UnplacedKeyframes& unplaced, const KnownPoses& poses) {
  std::vector<std::uint64_t> ids;
  while (unplaced.may_be_placed(poses))
    if (const auto entry = unplaced.take_placed(poses)) ids.push_back(entry->images->keyframe_id());
  return ids;
}

TEST(UnplacedKeyframes, OnlyAKeyframeOfASubmapThatNoPoseIsToldOfHasNoPlace) {
  KnownPoses poses;
  EXPECT_FALSE(UnplacedKeyframes::has_no_place(keyframe(3, 0), poses));
  EXPECT_TRUE(UnplacedKeyframes::has_no_place(keyframe(3, 1), poses));
  tell(poses, 1, {3});
  EXPECT_FALSE(UnplacedKeyframes::has_no_place(keyframe(3, 1), poses)) << "its submap was joined meanwhile";
}

TEST(UnplacedKeyframes, WaitUntilTheTrackerTellsTheirPlace) {
  KnownPoses poses;
  tell(poses, 1, {0, 1});
  UnplacedKeyframes unplaced(10);
  for (const std::uint64_t id : {5, 4, 7}) unplaced.hold(keyframe(id, id == 7 ? 2 : 1));
  EXPECT_THAT(take_all(unplaced, poses), ElementsAre());
  EXPECT_FALSE(unplaced.may_be_placed(poses)) << "nothing is looked for twice";
  tell(poses, 2, {0, 1, 4, 5, 6});
  EXPECT_THAT(take_all(unplaced, poses), ElementsAre(4, 5));
  EXPECT_EQ(unplaced.size(), 1U);
  EXPECT_EQ(unplaced.dropped(), 0U);
}

TEST(UnplacedKeyframes, WhenFullEveryOtherOneGoes) {
  KnownPoses poses;
  UnplacedKeyframes unplaced(4);
  for (std::uint64_t id = 10; id < 15; ++id) unplaced.hold(keyframe(id, 1));
  EXPECT_EQ(unplaced.size(), 3U);
  EXPECT_EQ(unplaced.dropped(), 2U);
  tell(poses, 1, {10, 11, 12, 13, 14});
  EXPECT_THAT(take_all(unplaced, poses), ElementsAre(10, 12, 14));
}

}  // namespace
}  // namespace rds::mapper
