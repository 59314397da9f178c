// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/voxel_look.hpp"

#include <gtest/gtest.h>

namespace rds::mapper {
namespace {

constexpr SurfaceLook kChair{{100, 0, 0}, 3, true, {}};
constexpr SurfaceLook kTable{{0, 100, 0}, 2, true, {}};
constexpr SurfaceLook kBesideChair{{0, 0, 100}, 0, true, {3}};
constexpr SurfaceLook kBesideTable{{0, 0, 100}, 0, true, {2}};
constexpr SurfaceLook kSilent{{0, 0, 0}, 0, true, {}};
constexpr SurfaceLook kNobodyLooked{{200, 200, 200}, 0, false, {}};

VoxelLook look_of(const SurfaceLook& look, int times = 1) {
  VoxelLook voxel;
  for (int i = 0; i < times; ++i) voxel.add(look);
  return voxel;
}

TEST(VoxelLook, HasTheMeanColour) {
  VoxelLook voxel = look_of(kChair);
  voxel.add(kTable);
  EXPECT_EQ(voxel.color(), (std::array<std::uint8_t, 3>{50, 50, 0}));
}

TEST(VoxelLook, AQuarterOfTheVotesMakesALabel) {
  VoxelLook voxel = look_of(kBesideChair, 3);
  voxel.add(kChair);
  EXPECT_EQ(voxel.label(), 3);
  for (int i = 0; i < 5; ++i) voxel.add(kBesideTable);
  EXPECT_EQ(voxel.label(), 3) << "says nothing of chairs";
  voxel.add(kBesideChair);
  EXPECT_EQ(voxel.label(), 0);
}

TEST(VoxelLook, OfEqualVotesTheLowerIndexWins) {
  VoxelLook voxel = look_of(kChair);
  voxel.add(kTable);
  EXPECT_EQ(voxel.label(), 2);
}

TEST(VoxelLook, SilenceOutvotesInTheEndAndWhoHasNotLookedIsNotSilent) {
  VoxelLook voxel = look_of(kSilent, 16);
  voxel.add(kChair);
  for (int i = 0; i < 100; ++i) voxel.add(kNobodyLooked);
  EXPECT_EQ(voxel.label(), 3);
  voxel.add(kSilent);
  EXPECT_EQ(voxel.label(), 0);
}

TEST(VoxelLook, WhatIsRemovedWasNeverThere) {
  VoxelLook voxel = look_of(kTable, 2);
  for (const auto& look : {kChair, kBesideChair, kSilent, kNobodyLooked}) voxel.add(look);
  for (const auto& look : {kNobodyLooked, kBesideChair, kChair, kSilent}) voxel.remove(look);
  map_file::ByteWriter after;
  map_file::ByteWriter before;
  voxel.put(after);
  look_of(kTable, 2).put(before);
  EXPECT_EQ(after.take(), before.take());
}

TEST(VoxelLook, ItsVotesGoToTheSameLabelsOfAnotherTable) {
  VoxelLook voxel = look_of(kTable, 2);
  voxel.add(kChair);
  constexpr std::array<std::uint16_t, 4> kSwapped{0, 1, 3, 2};
  const VoxelLook swapped = voxel.relabelled(kSwapped);
  EXPECT_EQ(voxel.label(), 2);
  EXPECT_EQ(swapped.label(), 3);
  EXPECT_EQ(swapped.color(), voxel.color());
  constexpr std::array<std::uint16_t, 4> kFullTable{0, 1, 0, 3};
  EXPECT_EQ(voxel.relabelled(kFullTable).label(), 3);
}

TEST(VoxelLook, OutlastsItsBytesAndRefusesImpossibleOnes) {
  VoxelLook voxel = look_of(kTable, 2);
  voxel.add(kChair);
  map_file::ByteWriter writer;
  voxel.put(writer);
  const auto bytes = writer.take();
  map_file::ByteReader reader(bytes);
  EXPECT_EQ(VoxelLook::get(reader, 4).label(), 2);
  EXPECT_TRUE(reader.finish());
  map_file::ByteReader few_labels(bytes);
  VoxelLook::get(few_labels, 3);
  EXPECT_FALSE(few_labels.finish());
}

}  // namespace
}  // namespace rds::mapper
