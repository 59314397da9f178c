// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/depth_noise.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace rds::geometry {
namespace {

double sigma_mm(std::string_view name, double depth_m) {
  return 1000 * depth_noise(name).value().sigma_m(depth_m);
}

// At random 1.425e-3 z²; depths that are next to each other lie 2.85e-3 z² apart (7 cm at 5 m), and rounding
// to them adds a 12th of their square.
TEST(DepthNoise, OfPrimeSenseIsThatOfKhoshelham) {
  for (const double z : {1.0, 2.0, 5.0}) {
    const double expected = std::hypot(1.425, 2.85 / std::sqrt(12.0)) * z * z;
    EXPECT_NEAR(sigma_mm("kinect_v1", z), expected, 0.005 * expected);
    EXPECT_EQ(sigma_mm("xtion", z), sigma_mm("kinect_v1", z));
  }
}

TEST(DepthNoise, IsTheSameByTwoSourcesWhereTheyMeasured) {
  for (double z = 1; z <= 5; z += 0.25) {
    const double by_nguyen = 1.2 + 1.9 * (z - 0.4) * (z - 0.4);
    EXPECT_NEAR(sigma_mm("kinect_v1", z) / by_nguyen, 1, 0.13) << z;
  }
}

TEST(DepthNoise, OfStereoGrowsWithDepthSquared) {
  EXPECT_NEAR(sigma_mm("realsense", 2), 4 * 0.08 / (424 * 0.05) * 1000, 1e-6);
  EXPECT_NEAR(sigma_mm("realsense", 4) / sigma_mm("realsense", 2), 4, 1e-9);
}

TEST(DepthNoise, OfTimeOfFlightStaysWithinWhatIsSpecified) {
  EXPECT_NEAR(sigma_mm("azure_kinect", 2), 1.5 - 0.5 * 2 + 0.3 * 4, 0.02);
  EXPECT_LT(sigma_mm("azure_kinect", 3.86), 17);
}

TEST(DepthNoise, GrowsAndIsNeverZero) {
  for (const DepthNoise& noise : kDepthNoises)
    for (double z = 0.1; z < 10; z += 0.1) {
      EXPECT_GT(noise.sigma_m(z), 0) << noise.name;
      EXPECT_GE(noise.sigma_m(z + 0.1), noise.sigma_m(z)) << noise.name;
      EXPECT_GT(noise.plane_tolerance_m(z), 3 * noise.sigma_m(z)) << noise.name;
      EXPECT_FLOAT_EQ(noise.sigma_m(static_cast<float>(z)), static_cast<float>(noise.sigma_m(z)));
    }
}

TEST(DepthNoise, HasNamesThatDiffer) {
  std::set<std::string_view> names;
  for (const DepthNoise& noise : kDepthNoises) {
    EXPECT_TRUE(names.insert(noise.name).second);
    EXPECT_EQ(depth_noise(noise.name), noise);
  }
  EXPECT_FALSE(depth_noise("kinect"));
}

}  // namespace
}  // namespace rds::geometry
