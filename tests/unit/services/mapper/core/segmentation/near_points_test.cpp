// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/near_points.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace rds::mapper {
namespace {

TEST(NearPoints, AgreeWithDistancesToAQuarterOfTheRadius) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> coordinate(-2, 2);
  const auto some = [&] {
    return Eigen::Vector3f(coordinate(random), coordinate(random), coordinate(random));
  };
  std::vector<Eigen::Vector3f> points(5);
  for (auto& p : points) p = some();
  const float radius_m = 0.8F;
  const NearPoints near(points, radius_m);
  const float slack_m = radius_m / 4 * std::sqrt(3.0F);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f p = some();
    float distance = 100;
    for (const auto& q : points) distance = std::min(distance, (p - q).norm());
    if (std::abs(distance - radius_m) < slack_m) continue;
    EXPECT_EQ(near.contains(p), distance < radius_m) << distance;
    inside += distance < radius_m ? 1 : 0;
  }
  EXPECT_GT(inside, 20);
}

TEST(NearPoints, FarAwayIsNotNear) {
  const NearPoints near({Eigen::Vector3f(0, 0, 1)}, 0.5F);
  EXPECT_TRUE(near.contains({0, 0, 1}));
  EXPECT_FALSE(near.contains({1000, 0, 1}));
}

}  // namespace
}  // namespace rds::mapper
