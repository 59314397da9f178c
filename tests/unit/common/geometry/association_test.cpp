// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/association.hpp"

#include <cstdint>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rds::geometry {
namespace {
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TEST(Associate, TakesNearestWithinTolerance) {
  const std::vector<double> a{0, 1, 2};
  const std::vector<double> b{.015, 1.03, 1.99};
  EXPECT_THAT(associate<double>(a, b, .02), ElementsAre(Pair(0, 0), Pair(2, 2)));
}

TEST(Associate, UsesEachElementOnce) {
  const std::vector<std::int64_t> a{0, 10};
  const std::vector<std::int64_t> b{6};
  EXPECT_THAT(associate<std::int64_t>(a, b, 20), ElementsAre(Pair(1, 0)));
}

TEST(Associate, GivesTheSecondBestToTheLoser) {
  const std::vector<std::int64_t> a{0, 10};
  const std::vector<std::int64_t> b{8, 19};
  EXPECT_THAT(associate<std::int64_t>(a, b, 20), ElementsAre(Pair(0, 1), Pair(1, 0)));
}

TEST(Associate, OfNothingIsNothing) {
  EXPECT_THAT(associate<double>({}, {}, 1.0), IsEmpty());
}

TEST(PairInOrder, PairsAllThatCanBePaired) {
  const std::vector<std::int64_t> a{0, 32, 64, 96};
  const std::vector<std::int64_t> b{13, 50, 79, 115};
  EXPECT_THAT(pair_in_order(a, b, 20), ElementsAre(Pair(0, 0), Pair(1, 1), Pair(2, 2), Pair(3, 3)));
}

TEST(PairInOrder, PrefersSmallDifferencesAmongEquallyManyPairs) {
  const std::vector<std::int64_t> a{10};
  const std::vector<std::int64_t> b{0, 9, 12, 25};
  EXPECT_THAT(pair_in_order(a, b, 20), ElementsAre(Pair(0, 1)));
  EXPECT_THAT(pair_in_order(b, a, 20), ElementsAre(Pair(1, 0)));
}

TEST(PairInOrder, LeavesOutWhatIsTooFar) {
  const std::vector<std::int64_t> a{0, 100, 200};
  const std::vector<std::int64_t> b{121, 199, 260};
  EXPECT_THAT(pair_in_order(a, b, 20), ElementsAre(Pair(2, 1)));
  EXPECT_THAT(pair_in_order(a, {}, 20), IsEmpty());
  EXPECT_THAT(pair_in_order({}, b, 20), IsEmpty());
}

}  // namespace
}  // namespace rds::geometry
