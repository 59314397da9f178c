// SPDX-License-Identifier: Apache-2.0
// Whatever comes, goes and is decided anew in whatever order, and whether it was added up in between: a block
// says what it would say had it been told once.
#include "services/mapper/core/evidence/evidence_block.hpp"

#include <map>

#include <gtest/gtest.h>

#include "tests/unit/services/mapper/core/evidence/random_sight.hpp"

namespace rds::mapper {
namespace {

using Entry = EvidenceBlock::Entry;

constexpr std::size_t kMany = 400;  // several prefixes

std::shared_ptr<KeyframeView> random_view(std::mt19937& random) {
  const BlockSight sight = test::random_sight(random);
  auto view = std::make_shared<KeyframeView>();
  view->set_surfaces({false, false});
  view->add({0, 0, 0}, sight, test::parts_of(sight), test::looks_of(sight, random));
  return view;
}

/// A block, and what it was told.
class Told {
 public:
  explicit Told(unsigned seed) : random_(seed) {}

  void add(std::uint64_t keyframe) {
    const auto view = random_view(random_);
    const auto time = static_cast<EvidenceTime>(100 * (keyframe / 2));  // two of the same time
    views_[keyframe] = view;
    entries_[keyframe] = {keyframe, time, 0, view};
    block_.add(entries_[keyframe]);
  }
  void remove(std::uint64_t keyframe) {
    block_.remove(rank(keyframe));
    entries_.erase(keyframe);
  }
  void decide(std::uint64_t keyframe) {
    views_.at(keyframe)->set_verdicts({SurfaceVerdict::kUndecided, SurfaceVerdict(random_() % 3U)});
    block_.outdate(rank(keyframe));
  }
  void expect_as_if_told_once() {
    EvidenceBlock fresh;
    for (const auto& [keyframe, entry] : entries_) fresh.add(entry);
    fresh.update();
    block_.update();
    EXPECT_TRUE(block_.occupancy().changed_since(fresh.occupancy()).empty());
    EXPECT_EQ(block_.occupancy().lasting, fresh.occupancy().lasting);
    EXPECT_EQ(block_.occupancy().row, fresh.occupancy().row);
    EXPECT_EQ(block_.occupancy().balance, fresh.occupancy().balance);
    const auto expect_same = [](const Sightings& a, const Sightings& b) {
      EXPECT_EQ(a.count, b.count);
      EXPECT_EQ(a.first, b.first);
      EXPECT_EQ(a.last, b.last);
    };
    expect_same(block_.counts().statics, fresh.counts().statics);
    expect_same(block_.counts().dynamics, fresh.counts().dynamics);
    for (std::uint16_t cell = 0; cell < kBlockCells; ++cell) {
      ASSERT_EQ(block_.look(cell) != nullptr, fresh.look(cell) != nullptr);
      if (fresh.look(cell) == nullptr) continue;
      EXPECT_EQ(block_.look(cell)->color(), fresh.look(cell)->color());
      EXPECT_EQ(block_.look(cell)->label(), fresh.look(cell)->label());
    }
  }
  EvidenceBlock& block() { return block_; }
  [[nodiscard]] bool has(std::uint64_t keyframe) const { return entries_.contains(keyframe); }
  [[nodiscard]] std::size_t size() const { return entries_.size(); }

 private:
  [[nodiscard]] EvidenceBlock::Rank rank(std::uint64_t keyframe) const {
    return {entries_.at(keyframe).time, keyframe};
  }
  std::mt19937 random_;
  EvidenceBlock block_;
  std::map<std::uint64_t, Entry> entries_;
  std::map<std::uint64_t, std::shared_ptr<KeyframeView>> views_;
};

TEST(EvidenceBlock, IsAFunctionOfWhatItWasTold) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Told told(seed);
    std::mt19937 random(seed);
    for (std::uint64_t keyframe = 0; keyframe < kMany; ++keyframe) {
      told.add(keyframe);
      if (random() % 4U == 0) told.block().update();
    }
    for (int event = 0; event < 200; ++event) {
      const std::uint64_t keyframe = random() % (kMany + 50U);
      if (!told.has(keyframe))
        told.add(keyframe);
      else if (random() % 3U == 0)
        told.decide(keyframe);
      else
        told.remove(keyframe);
      if (random() % 4U == 0) told.block().add_newest();
      if (random() % 8U == 0) told.block().update();
      if (random() % 8U == 0) told.block().counts();
    }
    told.expect_as_if_told_once();
    if (HasFailure()) FAIL() << "seed " << seed;
  }
}

TEST(EvidenceBlock, WhatChangesNearTheEndCostsNoMoreThanWhatLiesBehindIt) {
  Told told(1);
  for (std::uint64_t keyframe = 0; keyframe < 20 * kMany; ++keyframe) told.add(keyframe);
  told.block().update();
  EXPECT_EQ(told.block().not_added_up(), 0U);
  for (const std::size_t behind : {1U, 15U, 100U, 1000U, 5000U}) {
    told.remove(20 * kMany - behind);
    EXPECT_LE(told.block().not_added_up(), 2 * behind + 64);
    told.block().update();
  }
}

TEST(EvidenceBlock, WhatBecomesFinalStaysAsItIs) {
  Told told(2);
  for (std::uint64_t keyframe = 0; keyframe < kMany; ++keyframe) told.add(keyframe);
  told.block().update();
  const BlockOccupancy before = told.block().occupancy();
  for (std::uint64_t keyframe = 0; keyframe < kMany; ++keyframe) {
    told.block().make_final({static_cast<EvidenceTime>(100 * (keyframe / 2)), keyframe});
    EXPECT_EQ(told.block().not_added_up(), 0U) << "nothing to add up again";
    if (keyframe % 37U != 0) continue;
    told.block().update();
    ASSERT_TRUE(told.block().occupancy().changed_since(before).empty());
  }
  ASSERT_NE(told.block().final_part(), nullptr);
  EXPECT_TRUE(told.block().final_part()->occupancy.changed_since(before).empty());
}

TEST(EvidenceBlock, WhatIsNewerThanAllShowsAtOnceWhereTheRestWouldTakeLong) {
  Told told(3);
  for (std::uint64_t keyframe = 0; keyframe < kMany; ++keyframe) told.add(keyframe);
  told.block().update();
  told.block().take_changed();
  told.remove(0);
  told.add(kMany);
  told.block().add_newest();
  EXPECT_GT(told.block().not_added_up(), kMany / 2) << "still to be done";
  EXPECT_FALSE(told.block().take_changed().empty());
  told.expect_as_if_told_once();
}

}  // namespace
}  // namespace rds::mapper
