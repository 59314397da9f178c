// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/mapper/core/evidence/final_map.hpp"
#include "services/mapper/core/evidence/observation.hpp"

namespace rds::mapper {
namespace {

constexpr auto kStatic = Observation::kStatic;
constexpr auto kPassed = Observation::kPassed;
constexpr auto kNoReturn = Observation::kNoReturn;
constexpr auto kNothing = Observation::kNone;

constexpr std::size_t kCell = 123;
constexpr EvidenceTime kApart = 1000;

/// One voxel that keyframes see one after the other.
class Voxel {
 public:
  Voxel& see(Observation observation, int times = 1, bool near_dynamic = false) {
    BlockStep step;
    if (observation == kStatic) {
      step.hit.insert(kCell);
      step.seen_static.insert(kCell);
    }
    if (observation == kPassed) step.passed.insert(kCell);
    if (observation == kNoReturn) step.no_return.insert(kCell);
    if (near_dynamic) step.near_dynamic.insert(kCell);
    for (int i = 0; i < times; ++i) block_.add(step);
    return *this;
  }
  Voxel& see_something_dynamic(int times = 1) { return see(kNothing, times, true); }
  [[nodiscard]] float log_odds() const { return in_nats(block_.values[kCell]); }
  [[nodiscard]] bool is_occupied() const { return log_odds() > 0; }
  [[nodiscard]] bool is_known() const { return block_.known.has(kCell); }
  /// Misses until it is free.
  [[nodiscard]] int misses_to_be_free(Observation miss = kPassed) const {
    Voxel later = *this;
    int misses = 0;
    for (; later.is_occupied() && misses < 100; ++misses) later.see(miss);
    return misses;
  }

 private:
  BlockOccupancy block_;
};

TEST(OccupancyModel, AddsThePapersLogOddsAndClamps) {
  Voxel voxel;
  EXPECT_FALSE(voxel.is_known());
  EXPECT_FLOAT_EQ(voxel.see(kStatic).log_odds(), 0.85F);
  EXPECT_FLOAT_EQ(voxel.see(kPassed).log_odds(), 0.44F);
  EXPECT_FLOAT_EQ(voxel.see(kStatic, 7).log_odds(), 3.476F);
  EXPECT_FLOAT_EQ(voxel.see(kPassed, 20).log_odds(), -1.992F);
}

TEST(OccupancyModel, WhatHasStoodForLongIsGoneAfterFiveMissesAndWhatIsPutThereIsInAfterThreeHits) {
  Voxel voxel;
  EXPECT_EQ(voxel.see(kStatic, 300).misses_to_be_free(), 5);
  voxel.see(kPassed, 100).see(kStatic, 2);
  EXPECT_FALSE(voxel.is_occupied());
  EXPECT_TRUE(voxel.see(kStatic).is_occupied());
}

TEST(OccupancyModel, WhatIsOftenMissedWhileItStandsTakesThePapersNine) {
  Voxel voxel;
  for (int i = 0; i < 100; ++i) voxel.see(kStatic, 3).see(kPassed);
  EXPECT_EQ(voxel.see(kStatic, 4).misses_to_be_free(), 9);
  EXPECT_EQ(voxel.see(kStatic, 4).misses_to_be_free(), 5) << "eight in a row";
}

TEST(OccupancyModel, AHitSaysThatTheMissesWereNoise) {
  Voxel voxel;
  voxel.see(kStatic, 20).see(kPassed, 4);
  EXPECT_FLOAT_EQ(voxel.log_odds(), 3.476F - 4 * 0.7F);
  EXPECT_FLOAT_EQ(voxel.see(kStatic).log_odds(), 3.476F - 4 * 0.41F + 0.85F) << "as the paper";
}

TEST(OccupancyModel, AGhostIsGoneAfterThreeMisses) {
  Voxel voxel;
  voxel.see(kStatic, 100).see_something_dynamic(101);
  EXPECT_FLOAT_EQ(voxel.log_odds(), 3.476F);
  EXPECT_EQ(voxel.misses_to_be_free(), 3);
  EXPECT_EQ(voxel.misses_to_be_free(kNoReturn), 3);
  EXPECT_EQ(voxel.see(kStatic).misses_to_be_free(), 5) << "as often static as dynamic";
}

TEST(OccupancyModel, RaysThroughAGhostTakeMoreUntilItIsSeenAgain) {
  Voxel voxel;
  voxel.see(kStatic, 3).see_something_dynamic(4);
  EXPECT_FLOAT_EQ(voxel.see(kPassed).log_odds(), 2.55F - 1.2F);
  EXPECT_FLOAT_EQ(voxel.see(kStatic).log_odds(), 2.55F - 0.41F + 0.85F);
}

TEST(OccupancyModel, RaysWithoutReturnTakeFromWhatIsSeldomSeen) {
  EXPECT_FLOAT_EQ(Voxel().see(kStatic).see(kNoReturn).log_odds(), 0.44F);
  EXPECT_FLOAT_EQ(Voxel().see(kNoReturn).log_odds(), 0);
  EXPECT_FALSE(Voxel().see(kNoReturn).is_known());
  EXPECT_FLOAT_EQ(Voxel().see(kStatic, 3).see(kNoReturn).log_odds(), 2.55F);
}

TEST(OccupancyModel, TellsWhichVoxelsHaveChanged) {
  BlockOccupancy before;
  BlockStep step;
  for (const std::size_t cell : {3U, 300U}) step.passed.insert(cell);
  before.add(step);
  BlockOccupancy after = before;
  for (int i = 0; i < 10; ++i) before.add(step);
  step.hit.insert(511);
  after.add(step);
  BlockMask expected = step.passed;
  expected.insert(511);
  EXPECT_EQ(after.changed_since(before), expected);
  EXPECT_TRUE(after.changed_since(after).empty());
}

/// When a voxel was static, and when dynamic.
BlockCounts counts_of(const std::vector<EvidenceTime>& statics, const std::vector<EvidenceTime>& dynamics) {
  BlockMask cell;
  cell.insert(kCell);
  BlockCounts counts;
  for (const EvidenceTime time : statics) counts.statics.add(cell, time);
  for (const EvidenceTime time : dynamics) counts.dynamics.add(cell, time);
  return counts;
}

TEST(OccupancyModel, WhatStandsOnlyWhileSomebodyIsThereIsTransient) {
  EXPECT_FALSE(is_transient(counts_of({1100}, {2000}), kCell, kApart)) << "as often as dynamic";
  EXPECT_TRUE(is_transient(counts_of({1100}, {2000, 3000}), kCell, kApart));
  EXPECT_FALSE(is_transient(counts_of({1100, 1000}, {2000, 3000}), kCell, kApart));
}

TEST(OccupancyModel, WhatStandsASecondBeforeOrAfterIsNotTransient) {
  EXPECT_FALSE(is_transient(counts_of({1000}, {2000, 2100, 2200}), kCell, kApart));
  EXPECT_FALSE(is_transient(counts_of({3200}, {2000, 2100, 2200}), kCell, kApart));
}

/// A voxel that has stood for long, as a saved map remembers it.
FinalBlock remembered() {
  FinalBlock block;
  block.add(kCell, kHighest, {});
  return block;
}

BlockStep step(BlockMask BlockStep::*what) {
  BlockStep made;
  (made.*what).insert(kCell);
  return made;
}

TEST(OccupancyModel, ASavedVoxelHasAlwaysBeenThere) {
  EXPECT_TRUE(seen_apart(remembered().counts, kCell, 0, kApart));
  EXPECT_FALSE(seen_apart(remembered().counts, kCell + 1, 0, kApart));
}

/// Misses until it is free.
int misses_to_be_free(BlockOccupancy voxel) {
  int misses = 0;
  for (; voxel.values[kCell] > 0 && misses < 100; ++misses) voxel.add(step(&BlockStep::passed));
  return misses;
}

TEST(OccupancyModel, WhatIsOnlyRememberedIsGoneAfterThreeMissesAndWhatIsSeenAgainAfterFive) {
  BlockOccupancy voxel = remembered().occupancy;
  EXPECT_EQ(misses_to_be_free(voxel), 3);
  voxel.add(step(&BlockStep::passed));
  voxel.add(step(&BlockStep::passed));
  BlockStep seen = step(&BlockStep::hit);
  seen.seen_static = seen.hit;
  for (int i = 0; i < kSolidRow; ++i) voxel.add(seen);
  EXPECT_EQ(voxel.values[kCell], kHighest) << "it was noise";
  EXPECT_EQ(misses_to_be_free(voxel), 5);
}

TEST(OccupancyModel, WhatIsOnlyRememberedOutlastsACheckpoint) {
  FinalMap map;
  map.blocks.emplace(packed(block_key({800, 800, 800})), std::make_shared<const FinalBlock>(remembered()));
  map_file::ByteWriter writer;
  map.put(writer);
  const auto bytes = writer.take();
  map_file::ByteReader reader(bytes);
  const FinalMap read = FinalMap::get(reader, 1);
  ASSERT_TRUE(reader.finish());
  ASSERT_EQ(read.blocks.size(), 1U);
  EXPECT_EQ(misses_to_be_free(read.blocks.begin()->second->occupancy), 3);
}

}  // namespace
}  // namespace rds::mapper
