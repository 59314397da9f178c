// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/mapper/core/evidence/final_map.hpp"

namespace rds::mapper {
namespace {

constexpr auto kStatic = static_cast<std::uint8_t>(Observation::kStatic);
constexpr auto kPassed = static_cast<std::uint8_t>(Observation::kPassed);
constexpr auto kNoReturn = static_cast<std::uint8_t>(Observation::kNoReturn);

constexpr EvidenceTime kApart = 1000;

struct Sight {
  EvidenceTime time;
  std::uint8_t cell;
};

/// One voxel that keyframes see one after the other.
class Voxel {
 public:
  Voxel& see(EvidenceTime time, std::uint8_t cell) {
    sights_.push_back({time, cell});
    return *this;
  }
  [[nodiscard]] BlockCounts counts() const {
    BlockCounts counts;
    for (const Sight& sight : sights_) counts.add(block_of(sight.cell), sight.time);
    return counts;
  }
  [[nodiscard]] bool is_ghost() const { return (decide(counts()).bits[kCell] & kGhost) != 0; }
  [[nodiscard]] bool is_transient() const { return mapper::is_transient(counts(), kCell, kApart); }
  [[nodiscard]] float log_odds() const {
    BlockLogOdds block;
    for (const Sight& sight : sights_) block.add(block_of(sight.cell), sight.time, decide(counts()));
    return in_nats(block.values[kCell]);
  }

 private:
  static constexpr std::size_t kCell = 123;
  static BlockObservations block_of(std::uint8_t cell) {
    BlockObservations observations{};
    observations[kCell] = cell;
    return observations;
  }
  std::vector<Sight> sights_;
};

TEST(OccupancyModel, AddsThePapersLogOddsAndClamps) {
  Voxel voxel;
  EXPECT_FLOAT_EQ(voxel.see(0, kStatic).log_odds(), 0.85F);
  EXPECT_FLOAT_EQ(voxel.see(1, kPassed).log_odds(), 0.44F);
  for (EvidenceTime t = 2; t < 9; ++t) voxel.see(t, kStatic);
  EXPECT_FLOAT_EQ(voxel.log_odds(), 3.476F);
  for (EvidenceTime t = 9; t < 29; ++t) voxel.see(t, kPassed);
  EXPECT_FLOAT_EQ(voxel.log_odds(), -1.992F);
}

TEST(OccupancyModel, AGhostWasStaticInFewerKeyframesThanDynamic) {
  Voxel voxel;
  EXPECT_FALSE(voxel.see(0, kStatic).is_ghost());
  voxel.see(100, kPassed | kNearDynamic).see(200, kPassed | kNearDynamic);
  EXPECT_TRUE(voxel.is_ghost());
  EXPECT_FALSE(voxel.see(300, kStatic).is_ghost());
}

TEST(OccupancyModel, RaysThroughAGhostTakeMoreUntilItIsSeenAgain) {
  Voxel voxel;
  for (EvidenceTime t = 0; t < 3; ++t) voxel.see(t, kStatic);  // 2.55
  for (EvidenceTime t = 3; t < 7; ++t) voxel.see(t, kNearDynamic);
  EXPECT_FLOAT_EQ(voxel.see(8, kPassed).log_odds(), 1.35F);
  voxel.see(9, kStatic).see(10, kNearDynamic);  // now the ray passed before it was static once more
  EXPECT_FLOAT_EQ(voxel.log_odds(), 2.55F - 0.41F + 0.85F);
}

TEST(OccupancyModel, RaysWithoutReturnTakeFromWhatIsSeldomSeen) {
  EXPECT_FLOAT_EQ(Voxel().see(0, kStatic).see(1, kNoReturn).log_odds(), 0.44F);
  EXPECT_FLOAT_EQ(Voxel().see(0, kNoReturn).log_odds(), 0);
  Voxel often;
  for (EvidenceTime t = 0; t < 3; ++t) often.see(t, kStatic);
  EXPECT_FLOAT_EQ(often.see(3, kNoReturn).log_odds(), 2.55F);
}

TEST(OccupancyModel, WhatStandsOnlyWhileSomebodyIsThereIsTransient) {
  Voxel voxel;
  voxel.see(2000, kNearDynamic).see(1100, kStatic);
  EXPECT_FALSE(voxel.is_transient()) << "as often as dynamic";
  EXPECT_TRUE(voxel.see(3000, kNearDynamic).is_transient());
  EXPECT_FALSE(voxel.see(1000, kStatic).is_transient());
}

TEST(OccupancyModel, WhatStandsASecondBeforeOrAfterIsNotTransient) {
  Voxel voxel;
  for (const EvidenceTime t : {2000, 2100, 2200}) voxel.see(t, kNearDynamic);
  EXPECT_FALSE(voxel.see(1000, kStatic).is_transient());
}

TEST(OccupancyModel, WhoStandsForHoursDoesNotBecomeAGhostByCounting) {
  BlockCounts counts;
  BlockObservations observations{};
  observations[0] = kStatic | kNearDynamic;
  for (int i = 0; i < 70'000; ++i) counts.add(observations, 0);
  EXPECT_EQ(decide(counts).bits[0], 0);
}

TEST(OccupancyModel, ASavedVoxelHasAlwaysBeenThere) {
  FinalMap map;
  map.add({100, 200, 300}, 850, std::nullopt);
  const FinalBlock& block = map.blocks.at(packed(block_key({100, 200, 300})));
  EXPECT_TRUE(seen_apart(block.counts, cell_of({100, 200, 300}), 0, kApart));
  EXPECT_FALSE(seen_apart(block.counts, cell_of({100, 200, 301}), 0, kApart));
}

}  // namespace
}  // namespace rds::mapper
