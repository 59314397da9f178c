// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/loops/loop_appearance.hpp"

#include <numbers>

#include <opencv2/core.hpp>

#include "services/tracker/core/loops/loop_drift.hpp"
#include "tests/unit/services/tracker/core/tracker_scene.hpp"

namespace rds::tracker {
namespace {

/// The map of a camera that has been carried along a wall, and the newest keyframe in it.
class LoopAppearance : public testing::Test {
 protected:
  LoopAppearance() {
    for (int i = 0; i < 12; ++i) test::step(tracker_, i);
    tracker_.map().keyframes().for_each([this](const Keyframe& k) { newest_ = k; });
  }
  /// Points of the whole map in the newest keyframe.
  [[nodiscard]] SeenAgain look(const Pose& move = Pose::Identity()) const {
    return look(move, tracker_.map());
  }
  [[nodiscard]] SeenAgain look(const Pose& move, const SlamMap& map) const {
    std::vector<PointId> points;
    map.points().for_each([&](const MapPoint& p) { points.push_back(p.id); });
    return see_again(map, points, newest_, newest_.map_from_camera.inverse() * move);
  }
  /// Other pictures hang on the wall's left part.
  void paint(double share) {
    cv::Mat picture = newest_.images->level(0).clone();
    cv::Mat left = picture(cv::Rect(0, 0, cvRound(share * picture.cols), picture.rows));
    cv::Mat mirrored;
    cv::flip(left, mirrored, -1);
    mirrored.copyTo(left);
    newest_.images = std::make_shared<const ImagePyramid>(picture, newest_.images->levels());
  }

  Tracker tracker_{test::small_config()};
  Keyframe newest_;
};

TEST_F(LoopAppearance, ThePlaceItselfLooksTheSame) {
  const auto again = look();
  EXPECT_GT(again.expected, 100);
  EXPECT_GT(again.log_odds(), 2);
}

TEST_F(LoopAppearance, TheSameShapeWithOtherPicturesDoesNot) {
  paint(1);
  const auto again = look();
  EXPECT_GT(again.expected, 100);
  EXPECT_LT(again.log_odds(), -15);
}

TEST_F(LoopAppearance, ThatAPartIsTheSameIsNotEnough) {
  paint(0.5);
  const auto again = look();
  EXPECT_GT(again.log_odds(), -15);
  EXPECT_LT(again.log_odds(), -1);
}

TEST_F(LoopAppearance, WhatStandsElsewhereIsNotExpected) {
  const auto again = look(test::pose(0, 0, 0.5));
  EXPECT_LT(again.expected, look().expected / 4);
}

TEST_F(LoopAppearance, NothingIsSaidOfAKeyframeWithoutAPicture) {
  newest_.images = nullptr;
  EXPECT_EQ(look().expected, 0);
}

TEST_F(LoopAppearance, NothingIsSaidOfAPlaceWithoutPictures) {
  SlamMap saved = tracker_.map();
  saved.keyframes().for_each([](Keyframe& k) { k.images = nullptr; });
  EXPECT_EQ(look(Pose::Identity(), saved).expected, 0);
}

SeenAgain seen(int alike, int expected, double angle_deg = 5) {
  SeenAgain again;
  for (int i = 0; i < expected; ++i) again.add(angle_deg * std::numbers::pi / 180, i < alike);
  return again;
}

TEST(LoopAppearanceOdds, RiseWithTheShareAsFarAsTwinsAllow) {
  EXPECT_LT(seen(60, 100).log_odds(), -2);
  EXPECT_NEAR(seen(70, 100).log_odds(), 0, 0.3);
  EXPECT_GT(seen(82, 100).log_odds(), 2);
  EXPECT_LT(seen(100, 100).log_odds(), 3.1);
  EXPECT_EQ(seen(30, 30).log_odds(), 0);
}

TEST(LoopAppearanceOdds, ExpectLessOfAPlaceThatIsSeenFromAnotherSide) {
  EXPECT_LT(seen(55, 100, 5).log_odds(), -3);
  EXPECT_GT(seen(55, 100, 25).log_odds(), 0.5);
  EXPECT_GT(seen(30, 100, 60).log_odds(), 0);
  EXPECT_LT(seen(30, 100, 60).log_odds(), 1) << "less is known, too";
}

/// Two rooms that are furnished alike in every detail, and a map that has not drifted so far.
TEST(LoopAppearanceOdds, DoNotOutweighWhatTheMapCannotHaveDrifted) {
  EXPECT_LT((seen(500, 500).log_odds() + LoopDrift{4.5, 40}.log_odds()), 0);
}

}  // namespace
}  // namespace rds::tracker
