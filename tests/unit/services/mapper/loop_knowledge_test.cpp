// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/loop_knowledge.hpp"

#include <gtest/gtest.h>

namespace rds::mapper {
namespace {

TEST(LoopKnowledge, RevisionsCountPerInstance) {
  LoopKnowledge loops;
  EXPECT_FALSE(loops.is_newer(0, 0));
  EXPECT_FALSE(loops.is_older(0, 0));
  EXPECT_TRUE(loops.is_newer(7, 1));
  loops.take(7, 3);
  EXPECT_TRUE(loops.is_older(7, 2));
  EXPECT_TRUE(loops.is_older(0, 0)) << "of a tracker that knows no loop yet";
  EXPECT_FALSE(loops.is_newer(7, 3));
  EXPECT_TRUE(loops.is_newer(7, 4));
}

TEST(LoopKnowledge, ARestartedLoopCloserIsNewerAlthoughItCountsFromTheBeginning) {
  LoopKnowledge loops;
  loops.take(7, 3);
  EXPECT_TRUE(loops.is_newer(8, 1));
  loops.take(8, 1);
  EXPECT_TRUE(loops.is_older(7, 3)) << "poses that know the former one only";
  EXPECT_FALSE(loops.is_newer(7, 9));
}

}  // namespace
}  // namespace rds::mapper
