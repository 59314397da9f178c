// SPDX-License-Identifier: Apache-2.0
#include "common/service/peers/election.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace rds::service {
namespace {

TEST(Election, WhoIsAloneIsActive) {
  EXPECT_TRUE(shall_be_active({1, false, 0}, {}));
  EXPECT_TRUE(shall_be_active({1, true, 5}, {}));
}

TEST(Election, TheOlderOfTwoActiveStays) {
  const Candidate old{9, true, 100};
  const Candidate young{1, true, 3};
  EXPECT_TRUE(shall_be_active(old, std::vector{young}));
  EXPECT_FALSE(shall_be_active(young, std::vector{old}));
}

TEST(Election, OfTwoOfOneAgeExactlyOneStays) {
  for (const double difference_s : {-0.9, -0.1, 0.0, 0.1, 0.9}) {
    const Candidate a{1, true, 10};
    const Candidate b{2, true, 10 + difference_s};
    EXPECT_TRUE(shall_be_active(a, std::vector{b})) << difference_s;
    EXPECT_FALSE(shall_be_active(b, std::vector{a})) << difference_s;
  }
}

TEST(Election, StandByWaitsForTheActiveOneAndTakesOverWithoutIt) {
  const Candidate waiting{1, false, 0};
  EXPECT_FALSE(shall_be_active(waiting, std::vector{Candidate{2, true, 0}}));
  EXPECT_TRUE(shall_be_active(waiting, std::vector{Candidate{2, false, 0}}));
}

}  // namespace
}  // namespace rds::service
