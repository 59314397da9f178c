// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/sort/sort.hpp"

#include <gmock/gmock.h>

namespace rds::tracker::prediction {
namespace {

using geometry::Box2;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Box2 box_at(double x, double y = 0) {
  return {x, y, x + 40, y + 100};
}

TEST(Sort, KeepsTheIdOfABoxThatMoves) {
  Sort sort({});
  for (int frame = 0; frame < 10; ++frame) {
    const std::vector<Box2> boxes = {box_at(5. * frame), box_at(400 - 5. * frame)};
    EXPECT_THAT(sort.update(1, boxes), ElementsAre(1, 2)) << frame;
  }
}

TEST(Sort, StartsATrackWhereOverlapIsTooSmall) {
  Sort sort({});
  EXPECT_THAT(sort.update(1, std::vector{box_at(0)}), ElementsAre(1));
  EXPECT_THAT(sort.update(1, std::vector{box_at(30)}), ElementsAre(2));
}

TEST(Sort, ForgetsATrackThatWentUnmatchedForLongerThanMaxAge) {
  Sort sort({.max_age = 2.5});
  sort.update(1, std::vector{box_at(0)});
  sort.update(1.5, {});
  EXPECT_EQ(sort.tracks().size(), 1U);
  sort.update(1.5, {});
  EXPECT_THAT(sort.tracks(), IsEmpty());
  EXPECT_THAT(sort.update(1, std::vector{box_at(0)}), ElementsAre(2)) << "ids are not used again";
}

TEST(Sort, ReportsATrackOnlyAfterEnoughHits) {
  Sort sort({.min_hits = 2});
  for (int frame = 0; frame < 3; ++frame) sort.update(1, {});
  for (const bool reported : {false, false, true, true}) {
    sort.update(1, std::vector{box_at(0)});
    EXPECT_EQ(sort.is_reported(sort.tracks()[0]), reported);
  }
}

}  // namespace
}  // namespace rds::tracker::prediction
