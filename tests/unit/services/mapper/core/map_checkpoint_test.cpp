// SPDX-License-Identifier: Apache-2.0
// A map that is made again from its checkpoint is the map it was.
#include <map>

#include <gmock/gmock.h>

#include "tests/unit/services/mapper/core/lasting_storage.hpp"
#include "tests/unit/services/mapper/core/random_keyframes.hpp"

namespace rds::mapper {
namespace {

using test::LastingStorage;
using ::testing::HasSubstr;
using Rows = LastingStorage::Rows;

constexpr std::uint64_t kEpoch = 17;

std::unique_ptr<SemanticMapper> mapper_on(Rows& rows, const MapperConfig& config = {}) {
  return std::make_unique<SemanticMapper>(config, kEpoch, std::make_unique<LastingStorage>(rows));
}

/// The checkpoint with all its parts, as a store that is written again and again has it.
void update(MapCheckpoint& whole, std::optional<MapCheckpoint> newer) {
  ASSERT_TRUE(newer);
  if (!newer->final_map) newer->final_map = std::move(whole.final_map);
  whole = std::move(*newer);
}

class RestoredMap : public ::testing::Test {
 protected:
  /// Keyframes, some of which get other boxes later.
  void map(SemanticMapper& mapper, int keyframes) {
    for (int i = 0; i < keyframes; ++i) {
      const auto input = world_.next();
      mapper.integrate(input);
      poses_.push_back({input.id, input.stamp_ns, world_.pose()});
      if (i % 3 == 0) mapper.set_boxes(input.id, {});
    }
  }
  Rows rows_;
  test::RandomKeyframes world_;
  std::vector<KeyframePose> poses_;
};

TEST_F(RestoredMap, IsTheMapAsItWasBitForBit) {
  auto before = mapper_on(rows_);
  map(*before, 12);
  before->settle(poses_);
  const auto checkpoint = before->checkpoint();
  ASSERT_TRUE(checkpoint);
  auto after = mapper_on(rows_);
  const auto restored = after->restore(*checkpoint);
  ASSERT_TRUE(restored) << restored.error();
  EXPECT_EQ(after->map().epoch, kEpoch);
  EXPECT_EQ(after->archive().size(), 12U);
  EXPECT_TRUE(test::saved_bytes(*after) == test::saved_bytes(*before));
  EXPECT_EQ(after->archive().lost(), 0U);
  EXPECT_GT(after->map().revision, 0U);
}

TEST_F(RestoredMap, GoesOnAsIfNothingHadHappened) {
  MapperConfig little;
  little.correction.memory_mb = 0.3;  // most records are in the storage
  auto through = std::make_unique<SemanticMapper>(MapperConfig{}, kEpoch);
  auto killed = mapper_on(rows_, little);
  MapCheckpoint checkpoint;
  for (int i = 0; i < 16; ++i) {
    const auto input = world_.next();
    poses_.push_back({input.id, input.stamp_ns, world_.pose()});
    for (auto* mapper : {through.get(), killed.get()}) mapper->integrate(input);
    update(checkpoint, killed->checkpoint());
    if (i % 5 != 4) continue;
    killed = mapper_on(rows_, little);
    ASSERT_TRUE(killed->restore(checkpoint));
  }
  for (auto* mapper : {through.get(), killed.get()}) mapper->settle(poses_);
  EXPECT_TRUE(test::saved_bytes(*killed) == test::saved_bytes(*through));
}

TEST_F(RestoredMap, KeyframesThatAreFinalAreInIt) {
  MapperConfig few;
  few.correction.max_keyframes = 4;
  auto before = mapper_on(rows_, few);
  MapCheckpoint checkpoint;
  for (int i = 0; i < 115; ++i) {
    before->integrate(world_.next());
    if (i % 7 == 0) update(checkpoint, before->checkpoint());
  }
  update(checkpoint, before->checkpoint());
  ASSERT_TRUE(checkpoint.final_map);
  EXPECT_LT(rows_.size(), 110U);
  auto after = mapper_on(rows_, few);
  ASSERT_TRUE(after->restore(checkpoint));
  EXPECT_EQ(after->archive().size(), 115U);
  EXPECT_EQ(after->archive().poses().size(), 4U);
  EXPECT_NEAR(static_cast<double>(after->map().tree().size()),
              static_cast<double>(before->map().tree().size()),
              0.05 * static_cast<double>(before->map().tree().size()));
}

TEST_F(RestoredMap, RecordsThatAreGoneAreCountedAndLeftOut) {
  auto before = mapper_on(rows_);
  map(*before, 6);
  const auto checkpoint = before->checkpoint();
  rows_.erase(2);
  rows_[4].pop_back();
  auto after = mapper_on(rows_);
  ASSERT_TRUE(after->restore(*checkpoint));
  EXPECT_EQ(after->archive().poses().size(), 4U);
  EXPECT_EQ(after->archive().lost(), 2U);
}

TEST_F(RestoredMap, IsNotMadeOnAnotherSavedMap) {
  auto before = mapper_on(rows_);
  map(*before, 3);
  const auto checkpoint = before->checkpoint();
  SemanticMapper saved(MapperConfig{});
  saved.integrate(world_.next());
  auto after = mapper_on(rows_);
  ASSERT_TRUE(test::start_from(*after, test::saved_bytes(saved)));
  const auto restored = after->restore(*checkpoint);
  ASSERT_FALSE(restored);
  EXPECT_THAT(restored.error(), HasSubstr("another saved map"));
  EXPECT_EQ(after->archive().size(), 0U);
}

TEST_F(RestoredMap, TornPartsAreRefusedAndChangeNothing) {
  auto before = mapper_on(rows_);
  map(*before, 3);
  const auto whole = before->checkpoint();
  for (std::size_t size = 0; size < whole->state.size(); ++size) {
    MapCheckpoint torn = *whole;
    torn.state.resize(size);
    EXPECT_FALSE(mapper_on(rows_)->restore(torn)) << size;
  }
  for (std::size_t size = 1; size < whole->keyframes.at(0).size(); ++size) {
    MapCheckpoint torn = *whole;
    torn.keyframes[0].resize(size);
    EXPECT_EQ(mapper_on(rows_)->restore(torn).has_value(), size % 112 == 0) << size;
  }
}

}  // namespace
}  // namespace rds::mapper
