// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/input/known_poses.hpp"

#include <gtest/gtest.h>

namespace rds::mapper {
namespace {

using geometry::KeyframePose;

TEST(LoopRevisions, CountPerInstance) {
  LoopRevisions loops;
  EXPECT_FALSE(loops.is_newer(0, 0));
  EXPECT_FALSE(loops.is_older(0, 0));
  EXPECT_TRUE(loops.is_newer(7, 1));
  loops.take(7, 3);
  EXPECT_TRUE(loops.is_older(7, 2));
  EXPECT_TRUE(loops.is_older(0, 0)) << "of a tracker that knows no loop yet";
  EXPECT_FALSE(loops.is_newer(7, 3));
  EXPECT_TRUE(loops.is_newer(7, 4));
}

TEST(LoopRevisions, ARestartedLoopCloserIsNewerAlthoughItCountsFromTheBeginning) {
  LoopRevisions loops;
  loops.take(7, 3);
  EXPECT_TRUE(loops.is_newer(8, 1));
  loops.take(8, 1);
  EXPECT_TRUE(loops.is_older(7, 3)) << "poses that know the former one only";
  EXPECT_FALSE(loops.is_newer(7, 9));
}

/// A message of the tracker, or of loop closer 7 with a correction.
KnownPoses::Message message(bool is_local, std::uint64_t revision, std::uint64_t loop_revision = 0) {
  KnownPoses::Message message;
  message.source(is_local ? 0 : 1);
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
  poses.take(message(true, 1), {pose(0, 0), pose(1, 1)});
  auto changes = message(true, 2);
  changes.base_revision(1);
  poses.take(changes, {pose(1, 1.5), pose(2, 2)});
  EXPECT_EQ(poses.poses().size(), 3U);
  EXPECT_EQ(x_of(poses, 1), 1.5);
  EXPECT_EQ(poses.revision(), 2U);
  changes.base_revision(9);  // a message was missed
  poses.take(changes, {pose(1, 8)});
  EXPECT_EQ(x_of(poses, 1), 1.5);
}

TEST(KnownPoses, LocalPosesThatMissALoopDoNotUndoIt) {
  KnownPoses poses;
  poses.take(message(true, 1), {pose(0, 0)});
  poses.take(message(false, 1, 1), {pose(0, 5)});
  EXPECT_EQ(x_of(poses, 0), 5);
  poses.take(message(true, 2), {pose(0, 0.1)});
  EXPECT_EQ(x_of(poses, 0), 5);
  poses.take(message(true, 3, 1), {pose(0, 5.1)});
  EXPECT_EQ(x_of(poses, 0), 5.1);
  EXPECT_EQ(poses.revision(), 3U) << "of the tracker";
}

TEST(KnownPoses, ALoopThatTheTrackerNeverTakesOverIsGivenUp) {
  KnownPoses poses;
  auto of_killed = message(false, 1, 1);  // it closed a loop, and was killed before the tracker followed it
  of_killed.loop_instance(8);
  poses.take(message(true, 1, 1), {pose(0, 5)});
  poses.take(of_killed, {pose(0, 7)});
  std::uint64_t revision = 2;
  for (int i = 0; i < 31; ++i) poses.take(message(true, revision++, 1), {pose(0, 5)});
  EXPECT_EQ(x_of(poses, 0), 7) << "the tracker may yet take it over";
  poses.take(message(true, revision, 1), {pose(0, 5)});
  EXPECT_EQ(x_of(poses, 0), 5);
  EXPECT_EQ(poses.revision(), revision);
  EXPECT_TRUE(poses.is_correction_due());
  auto next = message(false, 2, 2);  // of another process in its place
  next.loop_instance(9);
  poses.take(next, {pose(0, 6)});
  EXPECT_EQ(x_of(poses, 0), 6);
}

TEST(KnownPoses, TheMapFollowsALoopAtOnceAndLocalCorrectionsNowAndThen) {
  KnownPoses poses;
  for (int i = 0; i < 30; ++i) poses.note_keyframe();
  EXPECT_FALSE(poses.is_correction_due()) << "nothing is told";
  poses.take(message(true, 1), {pose(0, 0)});
  EXPECT_TRUE(poses.is_correction_due());
  poses.note_correction();
  poses.note_keyframe();
  EXPECT_FALSE(poses.is_correction_due());
  poses.take(message(false, 1, 1), {pose(0, 5)});
  EXPECT_TRUE(poses.is_correction_due());
}

}  // namespace
}  // namespace rds::mapper
