// SPDX-License-Identifier: Apache-2.0
// What counts near people: surfaces that others confirm, and none that was there only with them.
#include <gtest/gtest.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

const cv::Rect kTorso(120, 10, 80, 100);
const cv::Rect kLegs(120, 160, 80, 60);  // below the box and its margin, as behind a table
const cv::Rect kBody(120, 30, 80, 180);
const cv::Scalar kGreen(60, 160, 60);  // what has the person's colour would be his
constexpr double kPersonM = 1.5;
constexpr double kLegsM = 1.62;  // and a table's; in one plane with the person they would hold it
constexpr double kBodyM = 1.52;
constexpr double kWallM = 3.0;
constexpr std::uint64_t kTwoSeconds = 20;  // keyframes are 0.1 s apart

SyntheticKeyframe person_with_legs(std::uint64_t id) {
  return SyntheticKeyframe(id)
      .rectangle(kTorso, kPersonM)
      .rectangle(kLegs, kLegsM, kGreen)
      .box("person", kTorso, true);
}

SyntheticKeyframe legs_in_cells(std::uint64_t id, const cv::Rect& cells = {120, 160, 80, 20}) {
  return SyntheticKeyframe(id).rectangle(kLegs, kLegsM, kGreen).movable_cells(cells);
}

SyntheticKeyframe legs_alone(std::uint64_t id) {
  return SyntheticKeyframe(id).rectangle(kLegs, kLegsM, kGreen).looked_for_objects();
}

/// The map of some keyframes, settled.
class SurfaceVerdicts : public testing::Test {
 protected:
  void see(const KeyframeInput& input) {
    mapper_.integrate(input);
    mapper_.settle({});
  }
  [[nodiscard]] float log_odds(double x_px, double y_px, double depth_m) const {
    return test::log_odds_at(mapper_.map().tree(), test::point_at(x_px, y_px, depth_m));
  }
  /// As how often hit; 0 where it is not known.
  [[nodiscard]] int hits(double x_px, double y_px, double depth_m) const {
    const float l = log_odds(x_px, y_px, depth_m);
    return l > 0 ? static_cast<int>(std::lround(l / 0.85F)) : 0;
  }
  [[nodiscard]] int hits_on_legs() const { return hits(160, 190, kLegsM); }

  MapperConfig config_;
  SemanticMapper mapper_{config_};
};

TEST_F(SurfaceVerdicts, WithoutAnythingMovableThereAreNoDoubts) {
  LabelTable labels;
  const auto record = test::record_of(SyntheticKeyframe(0).rectangle(kLegs, kLegsM, kGreen), labels);
  EXPECT_EQ(std::ranges::count(record.classes, PixelClass::kDoubtful), 0);
  see(legs_alone(0));
  EXPECT_EQ(hits_on_legs(), 1);
}

TEST_F(SurfaceVerdicts, WhatStandsNearAPersonIsNotUsedAndTheWallBehindIs) {
  see(person_with_legs(0));
  EXPECT_EQ(hits_on_legs(), 0);
  EXPECT_FLOAT_EQ(log_odds(160, 60, kPersonM), -0.41F) << "the person";
  EXPECT_EQ(hits(40, 60, kWallM), 1);
}

TEST_F(SurfaceVerdicts, NearTheTrackersCellsToo) {
  see(legs_in_cells(0));
  EXPECT_EQ(hits(160, 170, kLegsM), 0);
  EXPECT_EQ(hits(160, 210, kLegsM), 0);
  EXPECT_EQ(hits(40, 60, kWallM), 1);
}

TEST_F(SurfaceVerdicts, InTheTrackersCellsASurfaceStandsIfTheRestOfItDoes) {
  see(legs_alone(0));
  see(legs_in_cells(kTwoSeconds));
  EXPECT_EQ(hits(160, 170, kLegsM), 2);
}

TEST_F(SurfaceVerdicts, WhatIsInTheTrackersCellsConfirmsNothing) {
  see(legs_in_cells(0, kLegs));
  see(legs_in_cells(kTwoSeconds, kLegs));
  EXPECT_EQ(hits(160, 170, kLegsM), 0);
}

TEST_F(SurfaceVerdicts, WhatIsSeenASecondBeforeStands) {
  see(legs_alone(0));
  see(person_with_legs(kTwoSeconds));
  EXPECT_EQ(hits_on_legs(), 2);
}

TEST_F(SurfaceVerdicts, WhatIsSeenASecondLaterHasStoodAllAlong) {
  see(person_with_legs(0));
  EXPECT_EQ(hits_on_legs(), 0);
  see(legs_alone(kTwoSeconds));
  EXPECT_EQ(hits_on_legs(), 2);
}

TEST_F(SurfaceVerdicts, WhatIsSeenAtTheSameTimeConfirmsNothing) {
  see(legs_alone(kTwoSeconds - 5));
  see(person_with_legs(kTwoSeconds));
  EXPECT_EQ(hits_on_legs(), 1);
}

TEST_F(SurfaceVerdicts, ASurfaceIsJudgedAsAWhole) {
  const auto table_beside_person = [] {
    return SyntheticKeyframe(kTwoSeconds)
        .rectangle(kTorso, kPersonM)
        .rectangle({60, 160, 200, 60}, kLegsM, kGreen)
        .box("person", kTorso, true);
  };
  see(SyntheticKeyframe(0).rectangle({60, 160, 160, 60}, kLegsM, kGreen).looked_for_objects());
  see(table_beside_person());
  EXPECT_EQ(hits(250, 190, kLegsM), 1) << "the end that nobody has seen before";
  SemanticMapper little(config_);
  little.integrate(SyntheticKeyframe(0).rectangle({60, 160, 20, 60}, kLegsM, kGreen).looked_for_objects());
  little.integrate(table_beside_person());
  little.settle({});
  EXPECT_FALSE(test::is_occupied(little.map().tree(), test::point_at(250, 190, kLegsM)));
}

TEST_F(SurfaceVerdicts, RadiusZeroIsOff) {
  config_.confirmation.radius_m = 0;
  LabelTable labels;
  const auto record = test::record_of(person_with_legs(0), labels, config_);
  EXPECT_EQ(std::ranges::count(record.classes, PixelClass::kDoubtful), 0);
}

/// Somebody is known in keyframes 0 and 2; of keyframe 1 nobody is.
class TransientSurfaces : public SurfaceVerdicts {
 protected:
  TransientSurfaces() {
    for (const std::uint64_t keyframe : {0, 2})
      see(SyntheticKeyframe(keyframe).rectangle(kBody, kBodyM).box("person", kBody, true));
  }
};

TEST_F(TransientSurfaces, WhoIsNotKnownInAKeyframeIsLeftOut) {
  see(SyntheticKeyframe(1).rectangle(kBody, kBodyM).looked_for_objects());
  EXPECT_FLOAT_EQ(log_odds(160, 120, kBodyM), -0.82F) << "twice dynamic, and nothing else";
  EXPECT_GT(hits(20, 120, kWallM), 0) << "the wall";
}

TEST_F(TransientSurfaces, WhatGoesOnBesideHimStays) {
  see(SyntheticKeyframe(1).rectangle({60, 30, 200, 180}, kBodyM).looked_for_objects());
  EXPECT_GT(log_odds(70, 120, kBodyM), 0);
}

TEST_F(TransientSurfaces, AnObjectThatTheDetectorFoundStays) {
  const auto before = log_odds(160, 120, kBodyM);
  see(SyntheticKeyframe(1).rectangle(kBody, kBodyM).box("chair", kBody, false));
  EXPECT_GT(log_odds(160, 120, kBodyM), before);
}

TEST_F(TransientSurfaces, WhatStandsASecondBeforeOrAfterStays) {
  see(SyntheticKeyframe(kTwoSeconds).rectangle(kBody, kBodyM).looked_for_objects());
  EXPECT_GT(log_odds(160, 120, kBodyM), -0.41F);
}

}  // namespace
}  // namespace rds::mapper
