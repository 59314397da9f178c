// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/keyframe_policy.hpp"

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

/// A camera that stands still in a static scene and tracks well.
KeyframeFacts calm() {
  KeyframeFacts facts;
  facts.since_last_s = 0.5;
  facts.inliers = facts.reference_points = 300;
  facts.close_tracked = 250;
  facts.has_depth = true;
  return facts;
}

TEST(KeyframePolicy, LeavesACalmSceneAlone) {
  EXPECT_FALSE(is_keyframe(calm(), KeyframeConfig{}));
}

TEST(KeyframePolicy, LooksAgainNowAndThenInACalmScene) {
  KeyframeFacts facts = calm();
  facts.since_last_s = 1;
  EXPECT_TRUE(is_keyframe(facts, KeyframeConfig{}));
}

TEST(KeyframePolicy, LooksOftenWhileMovableObjectsAreThere) {
  KeyframeFacts facts = calm();
  facts.movable_or_changed = true;
  facts.since_last_s = 0.2;
  EXPECT_TRUE(is_keyframe(facts, KeyframeConfig{}));
  facts.since_last_s = 0.13;
  EXPECT_FALSE(is_keyframe(facts, KeyframeConfig{}));
}

TEST(KeyframePolicy, NeedsDepth) {
  KeyframeFacts facts = calm();
  facts.since_last_s = 5;
  facts.has_depth = false;
  EXPECT_FALSE(is_keyframe(facts, KeyframeConfig{}));
}

TEST(KeyframePolicy, FollowsTheView) {
  KeyframeFacts turned = calm();
  turned.rotation_rad = 0.3;
  EXPECT_TRUE(is_keyframe(turned, KeyframeConfig{}));
  KeyframeFacts moved = calm();
  moved.translation_m = 0.2;
  EXPECT_TRUE(is_keyframe(moved, KeyframeConfig{}));
  moved.median_depth_m = 6;  // far away the same step changes little
  EXPECT_FALSE(is_keyframe(moved, KeyframeConfig{}));
}

TEST(KeyframePolicy, ActsBeforeTheReferenceIsLost) {
  KeyframeFacts facts = calm();
  facts.inliers = 200;
  EXPECT_TRUE(is_keyframe(facts, KeyframeConfig{}));
}

TEST(KeyframePolicy, WaitsTheShortestInterval) {
  KeyframeFacts facts = calm();
  facts.inliers = 50;
  facts.since_last_s = 0.03;
  EXPECT_FALSE(is_keyframe(facts, KeyframeConfig{}));
}

TEST(ChangeDetector, SeesASuddenDropOfFoundPoints) {
  ChangeDetector detector(0.35);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(detector.update(500, 300));
  EXPECT_FALSE(detector.update(500, 250));
  EXPECT_TRUE(detector.update(500, 120));
}

TEST(ChangeDetector, TakesNoNoticeOfTooFewPoints) {
  ChangeDetector detector(0.35);
  detector.update(500, 300);
  EXPECT_FALSE(detector.update(10, 0));
}

}  // namespace
}  // namespace rds::tracker
