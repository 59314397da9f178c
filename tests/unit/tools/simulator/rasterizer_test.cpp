// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/rendering/rasterizer.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "tools/simulator/rendering/silhouette.hpp"

namespace rds::simulator {
namespace {

const geometry::CameraModel kCamera{160, 120, 130, 130, 79.5, 59.5, {}};

/// A wall three metres before the camera, tilted about the vertical axis.
Mesh wall(float tilt, float cell) {
  Mesh mesh;
  const Eigen::Vector3f right(8 * std::cos(tilt), 0, 8 * std::sin(tilt));
  const Eigen::Vector3f down(0, 8, 0);
  add_quad(mesh, Eigen::Vector3f(0, 0, 3) - right / 2 - down / 2, right, down, {}, {}, cell);
  return mesh;
}

TEST(Rasterizer, CutsLeaveNoGapsAndEveryDepthLiesOnThePlane) {
  Rasterizer rasterizer(kCamera);
  for (const float tilt : {0.0F, 0.4F, -0.5F}) {
    rasterizer.clear();
    rasterizer.draw(wall(tilt, 0.13F), geometry::Pose::Identity());
    for (int y = 0; y < rasterizer.height(); ++y)
      for (int x = 0; x < rasterizer.width(); ++x) {
        const auto id = rasterizer.at(x, y);
        ASSERT_NE(id, 0U) << x << " " << y << " tilt " << tilt;
        const Eigen::Vector3f ray(rasterizer.ray_x(static_cast<float>(x)),
                                  rasterizer.ray_y(static_cast<float>(y)), 1);
        const float z = 1 / rasterizer.triangles()[id - 1].inverse_z.dot(ray);
        const float expected = 3 / (1 - ray.x() * std::tan(tilt));
        EXPECT_NEAR(z, expected, 1e-3F * expected);
      }
  }
}

TEST(Rasterizer, FacesThatLookAwayAreNotDrawn) {
  Rasterizer rasterizer(kCamera);
  rasterizer.clear();
  Mesh mesh;
  add_quad(mesh, {4, -4, 3}, {-8, 0, 0}, {0, 8, 0}, {}, {});
  rasterizer.draw(mesh, geometry::Pose::Identity());
  EXPECT_EQ(rasterizer.at(80, 60), 0U);
}

TEST(Rasterizer, TheNearerSurfaceHidesTheOtherInAnyOrder) {
  Mesh near = wall(0, 1);
  for (auto& v : near.vertices) v.position.z() = 2;
  for (auto& t : near.triangles) t.object = 7;
  const Mesh far = wall(0, 1);
  for (const bool near_first : {true, false}) {
    Rasterizer rasterizer(kCamera);
    rasterizer.clear();
    rasterizer.draw(near_first ? near : far, geometry::Pose::Identity());
    rasterizer.draw(near_first ? far : near, geometry::Pose::Identity());
    EXPECT_EQ(rasterizer.triangles()[rasterizer.at(10, 10) - 1].object, 7);
  }
}

TEST(Rasterizer, FloorUnderTheCameraIsClippedAtTheNearPlane) {
  Mesh floor;
  add_quad(floor, {-5, 1.4F, 5}, {10, 0, 0}, {0, 0, -10}, {}, {}, 20);
  Rasterizer rasterizer(kCamera);
  rasterizer.clear();
  rasterizer.draw(floor, geometry::Pose::Identity());
  const auto id = rasterizer.at(160, 239);
  ASSERT_NE(id, 0U);
  const Eigen::Vector3f ray(rasterizer.ray_x(160), rasterizer.ray_y(239), 1);
  EXPECT_NEAR(ray.y() / rasterizer.triangles()[id - 1].inverse_z.dot(ray), 1.4F, 1e-3F);
}

TEST(SilhouetteArea, OfASphereIsThatOfItsDisc) {
  Mesh sphere;
  add_ellipsoid(sphere, {0, 0, 4}, Eigen::Matrix3f::Identity() * 0.5F, 48, {});
  const geometry::CameraModel camera{640, 480, 525, 525, 319.5, 239.5, {}};
  const double radius = 525 * 0.5 / std::sqrt(16 - 0.25);
  const double expected = std::numbers::pi * radius * radius;
  EXPECT_NEAR(silhouette_area(sphere, camera, geometry::Pose::Identity()), expected, 0.02 * expected);
  const geometry::Pose aside(Eigen::Translation3d(4, 0, 0));  // outside the picture, still whole
  EXPECT_GT(silhouette_area(sphere, camera, aside), expected);
}

}  // namespace
}  // namespace rds::simulator
