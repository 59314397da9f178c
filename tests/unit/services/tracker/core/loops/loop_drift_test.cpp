// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/loops/loop_drift.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

/// Keyframes 1 m apart around a square of 4 m, each covisible with the one before it; the last one, number
/// 15, is 1 m from the first.
class LoopDriftTest : public testing::Test {
 protected:
  LoopDriftTest() {
    const auto features = test::view_of({}, Pose::Identity(), 0, random_).features;
    for (int k = 0; k < 16; ++k) {
      const auto side = static_cast<std::size_t>(k / 4);
      const double along = k % 4;
      const std::array<Eigen::Vector3d, 4> places{
          {{along, 0, 0}, {4, 0, along}, {4 - along, 0, 4}, {0, 0, 4 - along}}};
      const KeyframeId id =
          map_.add_keyframe(k, Pose(Eigen::Translation3d(places.at(side))), features).id;
      if (k > 0) join(id - 1, id);
    }
  }
  void join(KeyframeId a, KeyframeId b) {
    map_.keyframe(a)->covisible.push_back({b, 20});
    map_.keyframe(b)->covisible.push_back({a, 20});
  }
  /// The loop that has the last keyframe so far from where the map has it.
  [[nodiscard]] geometry::LoopMatch loop(double moved_m) const {
    const Pose seen = Eigen::Translation3d(moved_m, 0, 0) * map_.pose_of(15);
    return {15, 0, map_.pose_of(0).inverse() * seen};
  }

  std::mt19937 random_{1};
  SlamMap map_{ScalePyramid(8, 1.2)};
};

TEST_F(LoopDriftTest, IsMeasuredAlongTheShortestWayOverCovisibleKeyframes) {
  const auto around = drift_of(map_, loop(0.3));
  ASSERT_TRUE(around);
  EXPECT_NEAR(around->way_m, 15, 1e-9);
  EXPECT_NEAR(around->moved_m, 0.3, 1e-9);
  join(2, 13);  // from (2, 0) to (0, 3)
  EXPECT_NEAR(drift_of(map_, loop(0.3))->way_m, 2 + std::sqrt(13) + 2, 1e-9);
}

TEST_F(LoopDriftTest, IsATurn) {
  const Eigen::AngleAxisd turn(0.08, Eigen::Vector3d::UnitY());
  geometry::LoopMatch turned = loop(0.3);
  turned.earlier_from_later = turned.earlier_from_later * turn;
  EXPECT_NEAR(drift_of(map_, loop(0.3))->turned_rad, 0, 1e-9);
  EXPECT_NEAR(drift_of(map_, turned)->turned_rad, 0.08, 1e-9);
  EXPECT_NEAR(drift_of(map_, turned)->moved_m, 0.3, 1e-9);
}

TEST_F(LoopDriftTest, NothingIsKnownOfKeyframesThatNothingJoins) {
  map_.keyframe(7)->covisible = {{6, 20}};
  map_.keyframe(8)->covisible = {{9, 20}};
  EXPECT_FALSE(drift_of(map_, loop(0.3)));
}

/// The camera was lost after keyframe 7, and a submap began with keyframe 8.
class LoopDriftOfSubmaps : public LoopDriftTest {
 protected:
  LoopDriftOfSubmaps() {
    map_.keyframe(7)->covisible = {{6, 20}};
    map_.keyframe(8)->covisible = {{9, 20}};
    map_.records().submaps().go_on(1, 8);
  }
  void be_lost_for(std::int64_t seconds) {
    for (KeyframeId k = 8; k < 16; ++k) map_.records().all().find(k)->stamp_ns = seconds * 1'000'000'000;
  }
};

TEST_F(LoopDriftOfSubmaps, IsWhatTheCameraWouldHaveWalkedWhileItWasLost) {
  be_lost_for(2);
  const auto drift = drift_of(map_, loop(0.3));
  ASSERT_TRUE(drift);
  EXPECT_NEAR(drift->moved_m, std::hypot(1, 0.3), 1e-9);  // from keyframe 7 to where the loop has 8
  EXPECT_NEAR(drift->way_m, 14, 1e-9);
  EXPECT_NEAR(drift->gap_s, 2, 1e-6);
  EXPECT_GT(drift->log_odds(), 0);
  EXPECT_LT(drift_of(map_, loop(20))->log_odds(), -3);
}

TEST_F(LoopDriftOfSubmaps, IsTheSameSeenFromEitherSide) {
  be_lost_for(2);
  const geometry::LoopMatch there = loop(0.3);
  const geometry::LoopMatch back{there.earlier, there.later, there.earlier_from_later.inverse()};
  EXPECT_NEAR(drift_of(map_, there)->moved_m, drift_of(map_, back)->moved_m, 1e-9);
}

TEST_F(LoopDriftOfSubmaps, NothingIsKnownAfterALongTimeNorWhereTheClockWentBack) {
  be_lost_for(10);
  EXPECT_FALSE(drift_of(map_, loop(0.3)));
  be_lost_for(-10);
  EXPECT_FALSE(drift_of(map_, loop(0.3)));
}

TEST(LoopDriftOdds, FallWithTheDriftAndRiseWithTheWay) {
  EXPECT_GT((LoopDrift{0.1, 15}.log_odds()), 3);
  EXPECT_LT((LoopDrift{4, 15}.log_odds()), -3);
  EXPECT_GT((LoopDrift{4, 150}.log_odds()), (LoopDrift{4, 15}.log_odds()));
  EXPECT_LT((LoopDrift{0.1, 150}.log_odds()), (LoopDrift{0.1, 15}.log_odds()));
}

/// A pattern of a wall that is taken for itself beside: 27 cm and 4.4 degrees, after a way of 2 m.
TEST(LoopDriftOdds, ACameraTurnsLittleOnAShortWay) {
  EXPECT_GT((LoopDrift{0.27, 1.9}.log_odds()), 4);
  EXPECT_LT((LoopDrift{0.27, 1.9, 0, 0.077}.log_odds()), -2);
  EXPECT_GT((LoopDrift{0.27, 30, 0, 0.077}.log_odds()), 2);
  EXPECT_GT((LoopDrift{0.27, 1.9, 2, 0.7}.log_odds()), 0) << "a lost camera turns on";
}

TEST(LoopDriftOdds, WhoIsLedAstrayIsAsUnlikelyHoweverFar) {
  const double astray = LoopDrift{50, 15}.log_odds();
  EXPECT_NEAR(astray, (LoopDrift{5, 15}.log_odds()), 0.01);
  EXPECT_GT(astray, -4);
}

TEST(LoopDriftOdds, AreEvenAsFarAsALostCameraCanHaveWalked) {
  double before_m = 0;
  for (const double gap_s : {0.5, 1.0, 2.0}) {
    const auto reach_m = LoopDrift{.gap_s = gap_s}.reach_m();
    ASSERT_TRUE(reach_m);
    EXPECT_GT(*reach_m, before_m);
    EXPECT_NEAR((LoopDrift{.moved_m = *reach_m, .gap_s = gap_s}.log_odds()), 0, 1e-9);
    before_m = *reach_m;
  }
  EXPECT_FALSE(LoopDrift{.gap_s = 4}.reach_m()) << "anywhere";
  EXPECT_FALSE(LoopDrift{.gap_s = -1}.reach_m()) << "the clock went back";
}

}  // namespace
}  // namespace rds::tracker
