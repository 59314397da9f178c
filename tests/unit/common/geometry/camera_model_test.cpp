// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/camera_model.hpp"

#include <gtest/gtest.h>

namespace rds::geometry {
namespace {

CameraModel freiburg1() {
  return {640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
}

TEST(CameraModel, RayOfAProjectedPointPassesThroughThePoint) {
  const CameraModel camera = freiburg1();
  for (double x = -0.45; x <= 0.45; x += 0.15)
    for (double y = -0.35; y <= 0.35; y += 0.1) {
      const Eigen::Vector3d point(2 * x, 2 * y, 2.0);
      const Eigen::Vector3d ray = camera.ray(camera.project(point));
      EXPECT_LT((2.0 * ray - point).norm(), 1e-5) << point.transpose();
    }
}

TEST(CameraModel, RejectsNegativeFocalLengthAndNan) {
  CameraModel camera = freiburg1();
  EXPECT_TRUE(camera.is_valid());
  camera.fx = -1;
  EXPECT_FALSE(camera.is_valid());
  camera = freiburg1();
  camera.distortion[2] = std::nan("");
  EXPECT_FALSE(camera.is_valid());
}

}  // namespace
}  // namespace rds::geometry
