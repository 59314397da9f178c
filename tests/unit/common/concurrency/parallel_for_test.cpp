// SPDX-License-Identifier: Apache-2.0
#include "common/concurrency/parallel_for.hpp"

#include <atomic>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace rds::concurrency {
namespace {

TEST(ParallelFor, DoesEveryPartOnceTaskAfterTask) {
  ParallelFor helper;
  for (std::size_t count = 0; count < 200; ++count) {
    std::vector<int> done(count, 0);
    helper.run(count, [&](std::size_t i) { ++done[i]; });
    EXPECT_EQ(done, std::vector<int>(count, 1));
  }
}

TEST(ParallelFor, TwoPartsRunAtTheSameTime) {
  ParallelFor helper;
  std::atomic<int> there = 0;
  helper.run(2, [&](std::size_t) {  // each part waits for the other
    ++there;
    there.notify_all();
    for (int seen = there; seen < 2; seen = there) there.wait(seen);
  });
  EXPECT_EQ(there, 2);
}

TEST(ParallelFor, PassesOnWhatAPartThrowsAndGoesOn) {
  ParallelFor helper;
  for (int round = 0; round < 20; ++round) {
    EXPECT_THROW(helper.run(8,
                            [](std::size_t i) {
                              if (i == 3) throw std::runtime_error("part");
                            }),
                 std::runtime_error);
    std::atomic<int> done = 0;
    helper.run(8, [&](std::size_t) { ++done; });
    EXPECT_EQ(done, 8);
  }
}

}  // namespace
}  // namespace rds::concurrency
