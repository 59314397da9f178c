// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/keyframe_selector.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/known_place.hpp"

namespace rds::tracker {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

class KeyframeSelection : public testing::Test, protected test::KnownPlace {
 protected:
  KeyframeNeed need(const TrackedFrame& frame, bool scene_changed = false) {
    return selector.need_of_matched({context(), frame, reference, scene_changed});
  }
  KeyframeNeed need_of_followed(const TrackedFrame& frame) {
    return selector.need_of_followed({context(), frame, reference, false});
  }
  void add(const Pose& map_from_camera, std::int64_t time_ns) {
    reference = add_keyframe(map_from_camera, time_ns);
    selector.note_in_map(reference, time_ns);
  }

  KeyframeSelector selector{KeyframeConfig{}};
  KeyframeId reference = kNoId;
};

TEST_F(KeyframeSelection, TheFirstFrameWithDepthBeginsTheMap) {
  TrackedFrame frame = frame_at(Pose::Identity());
  frame.pose_is_given = true;
  EXPECT_EQ(need(frame), KeyframeNeed::kMap);
  std::vector<Feature> flat = frame.features->all();
  for (Feature& f : flat) f.depth_m = 0;
  frame.features = std::make_shared<const FeatureSet>(test::small_camera(), std::move(flat));
  EXPECT_EQ(need(frame), KeyframeNeed::kNone);
}

TEST_F(KeyframeSelection, AStillCameraInAStillSceneShowsTheDetectorAFrameASecond) {
  add(Pose::Identity(), 0);
  EXPECT_EQ(need(frame_at(Pose::Identity(), kSecond / 2)), KeyframeNeed::kNone);
  for (int i = 0; i < 3; ++i) selector.begin_frame();
  EXPECT_EQ(need(frame_at(Pose::Identity(), kSecond)), KeyframeNeed::kDetector);
  EXPECT_EQ(need(frame_at(Pose::Identity(), kSecond / 2), true), KeyframeNeed::kDetector) << "it changes";
}

TEST_F(KeyframeSelection, ANewViewEntersTheMapUnlessTooFewPointsAgree) {
  add(Pose::Identity(), 0);
  TrackedFrame turned = frame_at(test::pose(0, 0, 0, 1.1 * kMaxRotationRad), kSecond / 2);
  EXPECT_EQ(need(turned), KeyframeNeed::kMap);
  int kept = 0;
  for (PointId& point : turned.points)
    if (point != kNoId && ++kept >= kMinInliers) point = kNoId;
  EXPECT_EQ(turned.static_matches(), kMinInliers - 1);
  EXPECT_EQ(need(turned), KeyframeNeed::kNone);
}

TEST_F(KeyframeSelection, AViewThatAKeyframeHasHadForLongNeedsNoOther) {
  add(Pose::Identity(), 0);
  add(test::pose(0.5, 0, 0), kSecond);
  reference = 0;
  EXPECT_EQ(selector.nearest_view(map, frame_at(Pose::Identity(), 4 * kSecond), reference).keyframe, 1U);
  const auto known = selector.nearest_view(map, frame_at(Pose::Identity(), 6 * kSecond), reference);
  EXPECT_EQ(known.keyframe, 0U);
  EXPECT_NEAR(known.change, 0, 1e-9);
}

TEST_F(KeyframeSelection, AFollowedFrameThatLosesAThirdOfThePictureEntersTheMap) {
  add(Pose::Identity(), 0);
  TrackedFrame frame = frame_at(Pose::Identity(), kSecond / 2);
  EXPECT_EQ(need_of_followed(frame), KeyframeNeed::kNone) << "what it covers is what counts from here on";
  for (std::size_t i = 0; i < frame.points.size(); ++i)
    if ((*frame.features)[i].px.x() > 200) frame.points[i] = kNoId;
  EXPECT_EQ(need_of_followed(frame), KeyframeNeed::kMap);
}

}  // namespace
}  // namespace rds::tracker
