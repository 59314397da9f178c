// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/keyframe_view.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/mapper/core/evidence/random_sight.hpp"

namespace rds::mapper {
namespace {

void expect_same(const BlockSight& a, const BlockSight& b) {
  EXPECT_EQ(a.no_return, b.no_return);
  EXPECT_EQ(a.passed, b.passed);
  EXPECT_EQ(a.unknown, b.unknown);
  EXPECT_EQ(a.doubtful, b.doubtful);
  EXPECT_EQ(a.stable, b.stable);
  EXPECT_EQ(a.near_dynamic, b.near_dynamic);
}

TEST(KeyframeView, GivesBackWhatItWasGiven) {
  std::mt19937 random(5);
  std::vector<BlockSight> blocks(3);
  blocks[1].stable = BlockMask::all();
  blocks[2].passed = blocks[2].near_dynamic = BlockMask::all();
  for (int i = 0; i < 20; ++i) blocks.push_back(test::random_sight(random));
  KeyframeView view;
  std::vector<std::vector<SurfaceLook>> looks;
  for (std::uint16_t i = 0; i < blocks.size(); ++i) {
    looks.push_back(test::looks_of(blocks[i], random));
    view.add({static_cast<std::uint16_t>(8 * i), 16, 24}, blocks[i], test::parts_of(blocks[i]), looks[i]);
  }
  ASSERT_EQ(view.size(), blocks.size());
  for (std::uint16_t i = 0; i < blocks.size(); ++i) {
    expect_same(view.sight(i), blocks[i]);
    EXPECT_EQ(view.key(i)[0], 8 * i);
    auto look = looks[i].begin();
    view.for_each_look(i, [&](std::uint16_t cell, const SurfaceLook& its_look) {
      EXPECT_TRUE(blocks[i].seen_static().has(cell));
      EXPECT_EQ(its_look, *look++);
    });
    EXPECT_EQ(look, looks[i].end());
  }
}

TEST(KeyframeView, VerdictsDecideWhatSurfacesCount) {
  BlockSight sight;
  sight.stable.insert(10);
  sight.doubtful.insert(20);
  sight.unknown.insert(30);
  sight.near_dynamic.insert(30);
  sight.passed = ~sight.surfaces();
  KeyframeView view;
  view.set_surfaces({false, false});
  view.add({0, 0, 0}, sight, test::parts_of(sight), std::vector<SurfaceLook>(2));
  const auto hits = [&](SurfaceVerdict verdict) {
    view.set_verdicts({SurfaceVerdict::kUndecided, verdict});
    const BlockStep step = view.step(0);
    EXPECT_EQ(step.passed, sight.passed);
    EXPECT_EQ(step.near_dynamic, sight.near_dynamic);
    EXPECT_TRUE(step.seen_static.has(20));
    EXPECT_FALSE(step.seen_static.has(30));
    return std::array{step.hit.has(10), step.hit.has(20), step.hit.has(30)};
  };
  EXPECT_EQ(hits(SurfaceVerdict::kUndecided), (std::array{true, false, false}));
  EXPECT_EQ(hits(SurfaceVerdict::kConfirmed), (std::array{true, true, true}));
  EXPECT_EQ(hits(SurfaceVerdict::kTransient), (std::array{false, false, false}));
}

}  // namespace
}  // namespace rds::mapper
