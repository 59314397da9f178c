// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/statistics.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace rds::evaluation {
namespace {

TEST(Percentile, InterpolatesBetweenNeighbours) {
  const std::vector<double> sample{4, 1, 3, 2};
  EXPECT_DOUBLE_EQ(percentile(sample, 0), 1);
  EXPECT_DOUBLE_EQ(percentile(sample, 50), 2.5);
  EXPECT_DOUBLE_EQ(percentile(sample, 99), 3.97);
  EXPECT_DOUBLE_EQ(percentile(sample, 100), 4);
  EXPECT_TRUE(std::isnan(percentile({}, 50)));
}

TEST(Statistics, AreThoseOfTheErrors) {
  const std::vector<double> errors{3, 4, 0, 0};
  const auto s = statistics_of(errors);
  EXPECT_DOUBLE_EQ(s.rmse, 2.5);
  EXPECT_DOUBLE_EQ(s.mean, 1.75);
  EXPECT_DOUBLE_EQ(s.median, 1.5);
  EXPECT_DOUBLE_EQ(s.max, 4);
}

}  // namespace
}  // namespace rds::evaluation
