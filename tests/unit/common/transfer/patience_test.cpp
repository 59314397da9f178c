// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/patience.hpp"

#include <gtest/gtest.h>

namespace rds::transfer {
namespace {

using namespace std::chrono_literals;

TEST(Patience, IsOverWhenSomebodyHasWrittenForLong) {
  Patience patience;
  EXPECT_FALSE(patience.is_over(true, 7s));
  EXPECT_FALSE(patience.is_over(true, 11s));
  EXPECT_TRUE(patience.is_over(true, 12s));
}

TEST(Patience, WhereNobodyWritesItIsNeverOver) {
  Patience patience;
  for (Time now = 0s; now < 1h; now += 1min) EXPECT_FALSE(patience.is_over(false, now));
  EXPECT_FALSE(patience.is_over(true, 1h)) << "he has just come";
  EXPECT_FALSE(patience.is_over(false, 1h + 4s));
  EXPECT_FALSE(patience.is_over(true, 1h + 8s));
}

}  // namespace
}  // namespace rds::transfer
