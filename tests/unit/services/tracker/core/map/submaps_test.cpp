// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/submaps.hpp"

#include <gmock/gmock.h>

namespace rds::tracker {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TEST(Submaps, AllIsTheMapAtFirst) {
  Submaps submaps;
  submaps.go_on(Submaps::kMap, 0);
  submaps.go_on(Submaps::kMap, 100);
  EXPECT_EQ(submaps.of(5), Submaps::kMap);
  EXPECT_TRUE(submaps.is_whole());
  EXPECT_THAT(submaps.rows(), IsEmpty());
}

TEST(Submaps, KeepsRowsOfKeyframesAndJoinsThem) {
  Submaps submaps;
  submaps.go_on(submaps.next(), 10);
  submaps.go_on(1, 12);
  submaps.go_on(submaps.next(), 20);
  submaps.go_on(Submaps::kMap, 30);
  submaps.go_on(1, 40);
  EXPECT_THAT(submaps.rows(), ElementsAre(Pair(10, 1), Pair(20, 2), Pair(30, 0), Pair(40, 1)));
  EXPECT_EQ(submaps.of(9), Submaps::kMap);
  EXPECT_EQ(submaps.of(19), 1U);
  EXPECT_EQ(submaps.of(29), 2U);
  EXPECT_EQ(submaps.of(1000), 1U);
  EXPECT_EQ(submaps.next(), 3U);

  submaps.join(2, 1);
  EXPECT_THAT(submaps.rows(), ElementsAre(Pair(10, 1), Pair(30, 0), Pair(40, 1)));
  EXPECT_FALSE(submaps.is_whole());
  submaps.join(1, Submaps::kMap);
  EXPECT_THAT(submaps.rows(), IsEmpty());
  EXPECT_TRUE(submaps.is_whole());
  EXPECT_EQ(submaps.next(), 3U) << "numbers are not given twice";
}

}  // namespace
}  // namespace rds::tracker
