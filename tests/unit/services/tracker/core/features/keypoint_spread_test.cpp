// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/features/keypoint_spread.hpp"

#include <algorithm>
#include <array>
#include <random>

#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

/// 2000 strong corners crowd into one corner of the picture, 400 weak ones are everywhere.
std::vector<Corner> crowded() {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Corner> corners;
  for (int i = 0; i < 2000; ++i)
    corners.push_back({60 * unit(random), 60 * unit(random), 100 + unit(random)});
  for (int i = 0; i < 400; ++i)
    corners.push_back({600 * unit(random), 440 * unit(random), 10 + unit(random)});
  return corners;
}

bool same(const Corner& a, const Corner& b) {
  return a.x == b.x && a.y == b.y && a.score == b.score;
}

TEST(KeypointSpread, GivesAsManyAsWanted) {
  auto corners = crowded();
  EXPECT_EQ(spread_evenly(corners, 600, 440, 300).size(), 300U);
}

TEST(KeypointSpread, CrowdedCornersLeaveRoomForTheRest) {
  auto corners = crowded();
  std::array<int, 12> in_block{};
  for (const Corner& c : spread_evenly(corners, 600, 440, 300))
    ++in_block[static_cast<std::size_t>(4 * static_cast<int>(c.y / 147) + static_cast<int>(c.x / 150))];
  const auto [fewest, most] = std::ranges::minmax(in_block);
  EXPECT_GE(fewest, 5);
  EXPECT_LE(most, 120);
}

TEST(KeypointSpread, KeepsTheStrongestOfNeighbours) {
  std::vector<Corner> corners{{10, 10, 1}, {11, 10, 5}, {12, 10, 2}, {90, 90, 1}};
  const auto chosen = spread_evenly(corners, 100, 100, 2);
  ASSERT_EQ(chosen.size(), 2U);
  EXPECT_EQ(chosen[0].score, 5);
}

TEST(KeypointSpread, DoesNotDependOnTheOrderOfCorners) {
  auto corners = crowded();
  auto shuffled = corners;
  std::ranges::shuffle(shuffled, std::mt19937(1));
  EXPECT_TRUE(std::ranges::equal(spread_evenly(corners, 600, 440, 200),
                                 spread_evenly(shuffled, 600, 440, 200), same));
}

TEST(KeypointSpread, ReturnsFewCornersAsTheyAre) {
  std::vector<Corner> corners{{1, 2, 3}};
  EXPECT_EQ(spread_evenly(corners, 10, 10, 5).size(), 1U);
  corners.clear();
  EXPECT_TRUE(spread_evenly(corners, 10, 10, 5).empty());
}

TEST(KeypointSpread, SurvivesManyCornersAtOnePlace) {
  std::vector<Corner> corners(50, Corner{5, 5, 1});
  EXPECT_LE(spread_evenly(corners, 100, 100, 10).size(), 10U);
}

}  // namespace
}  // namespace rds::tracker
