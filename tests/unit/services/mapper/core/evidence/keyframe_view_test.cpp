// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/evidence/keyframe_view.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace rds::mapper {
namespace {

constexpr SurfacePart kPart{1, 0};

BlockObservations filled(std::uint8_t cell) {
  BlockObservations observations;
  observations.fill(cell);
  return observations;
}

std::vector<SurfacePart> parts_of(const BlockObservations& observations) {
  const auto is_surface = [](auto cell) { return observation_in(cell) >= Observation::kUnknown; };
  return std::vector(static_cast<std::size_t>(std::ranges::count_if(observations, is_surface)), kPart);
}

TEST(KeyframeView, GivesBackWhatItWasGiven) {
  std::mt19937 random(5);
  std::vector<BlockObservations> blocks{filled(0), filled(5), filled(2 | kNearDynamic)};
  for (int i = 0; i < 20; ++i) {
    auto& block = blocks.emplace_back();
    for (auto& cell : block) cell = static_cast<std::uint8_t>(random() % 6U | (random() % 2U) * kNearDynamic);
  }
  KeyframeView view;
  for (std::uint16_t i = 0; i < blocks.size(); ++i)
    view.add({static_cast<std::uint16_t>(8 * i), 16, 24}, blocks[i], parts_of(blocks[i]));
  ASSERT_EQ(view.size(), blocks.size());
  for (std::uint16_t i = 0; i < blocks.size(); ++i) {
    BlockObservations observations = filled(77);
    view.unpack(i, observations);
    EXPECT_EQ(observations, blocks[i]);
    EXPECT_EQ(view.key(i)[0], 8 * i);
  }
}

TEST(KeyframeView, VerdictsDecideWhatSurfacesCount) {
  BlockObservations block = filled(static_cast<std::uint8_t>(Observation::kPassed));
  block[10] = static_cast<std::uint8_t>(Observation::kStatic);
  block[20] = static_cast<std::uint8_t>(Observation::kDoubtful);
  block[30] = static_cast<std::uint8_t>(Observation::kUnknown) | kNearDynamic;
  KeyframeView view;
  view.set_surfaces({false, false});
  view.add({0, 0, 0}, block, parts_of(block));
  const auto decided = [&](SurfaceVerdict verdict) {
    view.set_verdicts({SurfaceVerdict::kUndecided, verdict});
    BlockObservations observations;
    view.unpack_decided(0, observations);
    EXPECT_EQ(observation_in(observations[0]), Observation::kPassed);
    EXPECT_NE(observations[30] & kNearDynamic, 0);
    return std::array{observation_in(observations[10]), observation_in(observations[20]),
                      observation_in(observations[30])};
  };
  constexpr auto kHit = Observation::kStatic;
  constexpr auto kNo = Observation::kNone;
  EXPECT_EQ(decided(SurfaceVerdict::kUndecided), (std::array{kHit, kNo, kNo}));
  EXPECT_EQ(decided(SurfaceVerdict::kConfirmed), (std::array{kHit, kHit, kHit}));
  EXPECT_EQ(decided(SurfaceVerdict::kTransient), (std::array{kNo, kNo, kNo}));
}

}  // namespace
}  // namespace rds::mapper
