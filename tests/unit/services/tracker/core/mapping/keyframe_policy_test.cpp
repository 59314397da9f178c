// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/keyframe_policy.hpp"

#include <gtest/gtest.h>

#include "services/tracker/core/pose/found_share.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

/// A camera that stands still in a static scene and tracks well.
KeyframeFacts calm() {
  KeyframeFacts facts;
  facts.since_last_s = 0.5;
  facts.inliers = facts.seen = facts.seen_by_reference = 300;
  facts.close_tracked = 250;
  facts.has_depth = true;
  return facts;
}

KeyframeNeed need(const KeyframeFacts& facts) {
  return keyframe_need(facts, KeyframeConfig{});
}

TEST(KeyframePolicy, LeavesACalmSceneAlone) {
  EXPECT_EQ(need(calm()), KeyframeNeed::kNone);
}

TEST(KeyframePolicy, LooksAgainNowAndThenInACalmScene) {
  KeyframeFacts facts = calm();
  facts.since_last_s = 1;
  EXPECT_EQ(need(facts), KeyframeNeed::kDetector);
}

/// The map can have points of it that three keyframes see; the detector could not place what it finds.
TEST(KeyframePolicy, AViewWithoutDepthIsForTheMapOnly) {
  KeyframeFacts facts = calm();
  facts.has_depth = false;
  facts.view_change = 1.1;
  EXPECT_EQ(need(facts), KeyframeNeed::kNone);
  facts.triangulates = true;
  EXPECT_EQ(need(facts), KeyframeNeed::kMap);
  facts.view_change = 0.5;
  facts.since_last_s = 10;
  EXPECT_EQ(need(facts), KeyframeNeed::kNone);
}

TEST(KeyframePolicy, LooksOftenWhileMovableObjectsAreThere) {
  KeyframeFacts facts = calm();
  facts.movable_or_changed = true;
  facts.since_last_s = 0.1;
  EXPECT_EQ(need(facts), KeyframeNeed::kDetector);
  facts.since_last_s = 0.07;
  EXPECT_EQ(need(facts), KeyframeNeed::kNone);
}

TEST(KeyframePolicy, TheMapTakesWhatItCanGetWhileMovableObjectsHideMost) {
  KeyframeFacts facts = calm();
  facts.since_last_s = 0.1;
  facts.inliers = facts.seen = facts.seen_by_reference = 60;
  EXPECT_EQ(need(facts), KeyframeNeed::kNone);
  facts.movable_or_changed = true;
  EXPECT_EQ(need(facts), KeyframeNeed::kMap);
}

TEST(KeyframePolicy, WhereMovableObjectsHideMostTheMapDoesNotWaitForTheDetectorsKeyframes) {
  KeyframeFacts facts = calm();
  facts.movable_or_changed = true;
  facts.inliers = facts.seen = facts.seen_by_reference = 120;
  facts.since_last_s = 0.03;
  facts.frames_since_last = 1;
  facts.since_map_s = 0.13;
  EXPECT_EQ(need(facts), KeyframeNeed::kMap);
  facts.since_map_s = 0.03;
  EXPECT_EQ(need(facts), KeyframeNeed::kNone);
}

TEST(KeyframePolicy, TheMapDoesNotWaitWhenHardlyAnythingIsLeft) {
  KeyframeFacts facts = calm();
  facts.since_last_s = facts.since_map_s = 0.03;
  facts.movable_or_changed = true;
  facts.inliers = facts.seen = facts.seen_by_reference = 100;
  EXPECT_EQ(need(facts), KeyframeNeed::kNone);
  facts.inliers = facts.seen = facts.seen_by_reference = 60;
  EXPECT_EQ(need(facts), KeyframeNeed::kMap);
}

TEST(KeyframePolicy, NeedsDepth) {
  KeyframeFacts facts = calm();
  facts.since_last_s = 5;
  facts.has_depth = false;
  EXPECT_EQ(need(facts), KeyframeNeed::kNone);
}

TEST(KeyframePolicy, TheMapNeedsNewViews) {
  KeyframeFacts facts = calm();
  facts.view_change = 1.1;
  EXPECT_EQ(need(facts), KeyframeNeed::kMap);
  facts.view_change = 0.9;
  EXPECT_EQ(need(facts), KeyframeNeed::kNone);
}

TEST(KeyframePolicy, TheMapNeedsAKeyframeBeforeTheReferenceIsLost) {
  KeyframeFacts facts = calm();
  facts.seen = 200;
  EXPECT_EQ(need(facts), KeyframeNeed::kMap);
}

TEST(KeyframePolicy, WaitsTheShortestInterval) {
  KeyframeFacts facts = calm();
  facts.seen = 50;
  facts.since_last_s = 0.03;
  EXPECT_EQ(need(facts), KeyframeNeed::kNone);
}

TEST(ViewChange, CountsTurnsAndStepsByHowFarTheSceneIs) {
  EXPECT_NEAR(view_change(test::pose(0, 0, 0, kMaxRotationRad), 2), 1, 1e-9);
  EXPECT_NEAR(view_change(test::pose(0, kMaxTranslationM, 0), 2), 1, 1e-9);
  EXPECT_NEAR(view_change(test::pose(0, kMaxTranslationM, 0), 4), 0.5, 1e-9);
}

TEST(FoundShare, TellsADropFromItsRunningMean) {
  FoundShare share;
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(share.update(500, 300), 1, 1e-9);
  EXPECT_NEAR(share.update(500, 150), 0.5, 1e-9);
  EXPECT_NEAR(share.update(500, 285), 1, 1e-9);  // the mean has gone down a little
}

TEST(FoundShare, TakesNoNoticeOfTooFewPoints) {
  FoundShare share;
  share.update(500, 300);
  EXPECT_EQ(share.update(10, 0), 1);
}

}  // namespace
}  // namespace rds::tracker
