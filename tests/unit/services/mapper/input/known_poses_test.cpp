// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/known_poses.hpp"

#include <gtest/gtest.h>

namespace rds::mapper {
namespace {

using geometry::KeyframePose;

/// A message of the tracker. @param loop_revision  of loop closer 7, that its poses contain; 0: none.
KnownPoses::Message message(std::uint64_t revision, std::uint64_t loop_revision = 0) {
  KnownPoses::Message message;
  message.revision(revision);
  message.loop_instance(loop_revision > 0 ? 7 : 0);
  message.loop_revision(loop_revision);
  return message;
}

KeyframePose pose(std::uint64_t id, double x) {
  KeyframePose pose;
  pose.id = id;
  pose.map_from_camera.translation().x() = x;
  return pose;
}

double x_of(const KnownPoses& poses, std::uint64_t id) {
  const auto* known = poses.find(id);
  return known == nullptr ? NAN : known->map_from_camera.translation().x();
}

TEST(KnownPoses, ChangesAreAppliedToWhatWasTold) {
  KnownPoses poses;
  poses.take(message(1), {pose(0, 0), pose(1, 1)});
  auto changes = message(2);
  changes.base_revision(1);
  poses.take(changes, {pose(1, 1.5), pose(2, 2)});
  EXPECT_EQ(poses.poses().size(), 3U);
  EXPECT_EQ(x_of(poses, 1), 1.5);
  EXPECT_EQ(poses.revision(), 2U);
  changes.base_revision(9);  // a message was missed
  poses.take(changes, {pose(1, 8)});
  EXPECT_EQ(x_of(poses, 1), 1.5);
}

TEST(KnownPoses, TheMapFollowsALoopAtOnceAndLocalCorrectionsNowAndThen) {
  KnownPoses poses;
  for (int i = 0; i < 30; ++i) poses.note_keyframe();
  EXPECT_FALSE(poses.is_correction_due()) << "nothing is told";
  poses.take(message(1), {pose(0, 0)});
  EXPECT_TRUE(poses.is_correction_due());
  poses.note_correction();
  poses.note_keyframe();
  EXPECT_FALSE(poses.is_correction_due());
  poses.take(message(2), {pose(0, 1)});
  EXPECT_FALSE(poses.is_correction_due());
  poses.take(message(3, 1), {pose(0, 5)});
  EXPECT_TRUE(poses.is_correction_due());
  poses.note_correction();
  poses.take(message(4, 1), {pose(0, 5)});
  EXPECT_FALSE(poses.is_correction_due()) << "the same loop";
  auto of_another = message(5, 1);  // another loop closer counts anew
  of_another.loop_instance(8);
  poses.take(of_another, {pose(0, 6)});
  EXPECT_TRUE(poses.is_correction_due());
}

}  // namespace
}  // namespace rds::mapper
