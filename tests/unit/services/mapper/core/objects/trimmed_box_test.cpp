// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/trimmed_box.hpp"

#include <random>

#include <gtest/gtest.h>

namespace rds::mapper {
namespace {

TEST(TrimmedBox, GoesFromTheSecondToTheNinetyEighthPercentile) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const std::size_t count : {1U, 2U, 49U, 50U, 256U}) {
    std::vector<Eigen::Vector3d> points(count);
    for (auto& p : points) p = {uniform(random), uniform(random), uniform(random)};
    const geometry::Box3 box = trimmed_box(points);
    for (int axis = 0; axis < 3; ++axis) {
      std::ranges::sort(points, {}, [axis](const Eigen::Vector3d& p) { return p[axis]; });
      EXPECT_EQ(box.min[axis], points[count / 50][axis]) << count;
      EXPECT_EQ(box.max[axis], points[count - 1 - count / 50][axis]) << count;
    }
  }
}

}  // namespace
}  // namespace rds::mapper
