// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/mapper/core/evidence/surface_rules.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

const cv::Rect kTorso(120, 10, 80, 100);
const cv::Rect kLegs(120, 160, 80, 60);  // below the box and its margin, as behind a table
constexpr double kPersonM = 1.5;
constexpr double kVoxelM = 0.05;
constexpr std::uint64_t kTwoSeconds = 20;  // keyframes are 0.1 s apart

KeyframeRecord record_of(const KeyframeInput& input, const MapperConfig& config = {}) {
  LabelTable labels;
  return test::record_of(input, labels, config);
}

SyntheticKeyframe person_with_legs(std::uint64_t id) {
  return SyntheticKeyframe(id)
      .rectangle(kTorso, kPersonM)
      .rectangle(kLegs, kPersonM)
      .box("person", kTorso, true);
}

PixelClass class_at(const KeyframeRecord& record, const StaticHistory& history, int x_px, int y_px) {
  const auto classes = resolve(record, {history, DynamicHistory(kVoxelM)}, {});
  return classes[record.grid.index(x_px / record.grid.stride, y_px / record.grid.stride)];
}

TEST(Confirmation, WithoutAnythingMovableThereAreNoDoubts) {
  const auto record = record_of(SyntheticKeyframe(0).rectangle(kLegs, kPersonM));
  EXPECT_TRUE(record.unconfirmed.surface.empty());
  EXPECT_EQ(resolve(record, {{}, DynamicHistory(kVoxelM)}, {}), record.classes);
}

TEST(Confirmation, WhatStandsNearAPersonIsNotUsedAndTheWallBehindIs) {
  const auto record = record_of(person_with_legs(0));
  EXPECT_EQ(class_at(record, {}, 160, 190), PixelClass::kInvalid);
  EXPECT_EQ(class_at(record, {}, 160, 60), PixelClass::kDynamic);
  EXPECT_EQ(class_at(record, {}, 40, 60), PixelClass::kStatic);
}

TEST(Confirmation, NearTheTrackersCellsToo) {
  const auto record =
      record_of(SyntheticKeyframe(0).rectangle(kLegs, kPersonM).movable_cells({120, 160, 80, 20}));
  EXPECT_EQ(class_at(record, {}, 160, 170), PixelClass::kInvalid);
  EXPECT_EQ(class_at(record, {}, 160, 210), PixelClass::kInvalid);
  EXPECT_EQ(class_at(record, {}, 40, 60), PixelClass::kStatic);
}

TEST(Confirmation, InTheTrackersCellsASurfaceStandsIfTheRestOfItDoes) {
  const auto in_cells = [](std::uint64_t id) {
    return SyntheticKeyframe(id).rectangle(kLegs, kPersonM).movable_cells({120, 160, 80, 20});
  };
  const auto record = record_of(in_cells(kTwoSeconds));
  StaticHistory seen_free;
  seen_free.see(record_of(SyntheticKeyframe(0).rectangle(kLegs, kPersonM)), {});
  EXPECT_EQ(class_at(record, seen_free, 160, 170), PixelClass::kStatic);
  StaticHistory seen_in_cells;  // says nothing of what is in them
  seen_in_cells.see(record_of(SyntheticKeyframe(0).rectangle(kLegs, kPersonM).movable_cells(kLegs)), {});
  EXPECT_EQ(class_at(record, seen_in_cells, 160, 170), PixelClass::kInvalid);
}

TEST(Confirmation, WhatIsSeenAtAnotherTimeStands) {
  const auto record = record_of(person_with_legs(kTwoSeconds));
  const auto history_of = [](std::uint64_t id) {
    StaticHistory history;
    history.see(record_of(SyntheticKeyframe(id).rectangle(kLegs, kPersonM)), {});
    return history;
  };
  EXPECT_EQ(class_at(record, history_of(0), 160, 190), PixelClass::kStatic);
  EXPECT_EQ(class_at(record, history_of(2 * kTwoSeconds), 160, 190), PixelClass::kStatic);
  EXPECT_EQ(class_at(record, history_of(kTwoSeconds - 5), 160, 190), PixelClass::kInvalid);
}

TEST(Confirmation, ASurfaceIsJudgedAsAWhole) {
  const cv::Rect table(60, 160, 200, 60);
  const auto record = record_of(SyntheticKeyframe(kTwoSeconds)
                                    .rectangle(kTorso, kPersonM)
                                    .rectangle(table, kPersonM)
                                    .box("person", kTorso, true));
  StaticHistory most;
  most.see(record_of(SyntheticKeyframe(0).rectangle({60, 160, 160, 60}, kPersonM)), {});
  EXPECT_EQ(class_at(record, most, 250, 190), PixelClass::kStatic);
  StaticHistory little;
  little.see(record_of(SyntheticKeyframe(0).rectangle({60, 160, 20, 60}, kPersonM)), {});
  EXPECT_EQ(class_at(record, little, 70, 190), PixelClass::kInvalid);
}

TEST(Confirmation, RadiusZeroIsOff) {
  MapperConfig config;
  config.confirmation.radius_m = 0;
  EXPECT_TRUE(record_of(person_with_legs(0), config).unconfirmed.surface.empty());
}

TEST(StaticHistory, ASavedVoxelHasAlwaysBeenThere) {
  StaticHistory history;
  history.know({100, 200, 300});
  constexpr std::int64_t kNow = 1'700'000'000'000'000'000;
  EXPECT_TRUE(history.seen_apart({100, 200, 300}, kNow, 1'000'000'000));
  EXPECT_FALSE(history.seen_apart({100, 200, 301}, kNow, 1'000'000'000));
}

TEST(SemanticMapper, LegsOutOfTheBoxStayOutAndATableComesInOnceItWasSeenAlone) {
  SemanticMapper mapper(MapperConfig{});
  const auto legs = test::point_at(160, 190, kPersonM);
  mapper.integrate(person_with_legs(0));
  EXPECT_FALSE(test::is_occupied(mapper.map().tree(), legs));
  mapper.integrate(SyntheticKeyframe(kTwoSeconds).rectangle(kLegs, kPersonM).looked_for_objects());
  EXPECT_FLOAT_EQ(test::log_odds_at(mapper.map().tree(), legs), 0.85F);
  mapper.settle({});
  EXPECT_FLOAT_EQ(test::log_odds_at(mapper.map().tree(), legs), 1.7F);  // now it has stood all along
}

TEST(SemanticMapper, DoubtsSettleToTheSameBytesWhateverTheOrderOfArrival) {
  const auto bytes_after = [](const std::vector<std::uint64_t>& order) {
    SemanticMapper mapper(MapperConfig{});
    for (const auto id : order)
      if (id % 2 == 0)
        mapper.integrate(person_with_legs(id * 7));
      else
        mapper.integrate(SyntheticKeyframe(id * 7).rectangle(kLegs, kPersonM).looked_for_objects());
    mapper.settle({});
    return test::saved_bytes(mapper);
  };
  EXPECT_EQ(bytes_after({0, 1, 2, 3, 4}), bytes_after({3, 0, 4, 2, 1}));
}

}  // namespace
}  // namespace rds::mapper
