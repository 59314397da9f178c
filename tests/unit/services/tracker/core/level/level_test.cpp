// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "services/tracker/core/level/level_pose.hpp"
#include "services/tracker/core/level/plane_normals.hpp"
#include "services/tracker/core/level/up_direction.hpp"

namespace rds::tracker {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979 / 180;

double angle_deg(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

/// camera_from_world of a camera that was upright, with z ahead, and is turned to its side, then tilted down.
Eigen::Matrix3d turned(double tilt_deg, double roll_deg) {
  return (Eigen::AngleAxisd(roll_deg * kDegree, Vector3d::UnitZ()) *
          Eigen::AngleAxisd(tilt_deg * kDegree, Vector3d::UnitX()))
      .toRotationMatrix();
}

/// n·p = d in the camera frame.
struct Plane {
  Vector3d normal;
  double distance;
};

const geometry::CameraModel kCamera{640, 480, 525, 525, 319.5, 239.5};

/// What a structured-light sensor measures of planes: the nearest in front, with noise and steps in 1/z.
class DepthPicture {
 public:
  explicit DepthPicture(std::span<const Plane> planes) : grid_(kCamera) {
    view_ = {&grid_, cv::Mat1f(grid_.size(), 0.F), {}};
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 1.4e-3);
    for (int row = 0; row < view_.depth_m.rows; ++row)
      for (int column = 0; column < view_.depth_m.cols; ++column) {
        double inverse = 0;
        for (const Plane& plane : planes)
          inverse =
              std::max(inverse, plane.normal.dot(grid_.ray(column, row).cast<double>()) / plane.distance);
        inverse = std::round((inverse + noise(random)) / 2.9e-3) * 2.9e-3;
        if (inverse > .2) view_.depth_m(row, column) = static_cast<float>(1 / inverse);
      }
  }
  DepthView& view() { return view_; }

 private:
  segmentation::GridGeometry grid_;
  DepthView view_;
};

/// A room around a camera 1.2 m above the floor: up is −y of the world, z is ahead.
std::vector<Plane> room(const Eigen::Matrix3d& camera_from_world) {
  std::vector<Plane> planes{{{0, 1, 0}, 1.2}, {{0, 0, 1}, 3.0}, {{-1, 0, 0}, 1.6}};
  for (Plane& plane : planes) plane.normal = camera_from_world * plane.normal;
  return planes;
}

class TiltedCamera : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(TiltedCamera, FindsUpFromOnePicture) {
  const Eigen::Matrix3d camera_from_world = turned(GetParam().first, GetParam().second);
  DepthPicture picture(room(camera_from_world));
  const UpDirection found = find_up(plane_normals(picture.view()));
  EXPECT_TRUE(found.is_seen);
  EXPECT_GT(found.level + found.upright, .8);
  EXPECT_LT(angle_deg(found.up, camera_from_world * -Vector3d::UnitY()), .5);
}

INSTANTIATE_TEST_SUITE_P(Degrees, TiltedCamera,
                         testing::Values(std::pair{0.0, 0.0}, std::pair{15.0, 5.0}, std::pair{30.0, -10.0},
                                         std::pair{45.0, 0.0}, std::pair{-20.0, 8.0}, std::pair{10.0, 40.0}),
                         [](const auto& test) { return "case" + std::to_string(test.index); });

TEST(FindUp, ThinksOfTheCamerasTiltWhereOneWallIsAllThatIsSeen) {
  const Eigen::Matrix3d camera_from_world = turned(20, 0);
  DepthPicture picture(std::vector<Plane>{{camera_from_world * Vector3d(0, 0, 1), 2.0}});
  const UpDirection found = find_up(plane_normals(picture.view()));
  EXPECT_FALSE(found.is_seen) << "the camera may be rolled about the wall's normal";
  EXPECT_LT(angle_deg(found.up, camera_from_world * -Vector3d::UnitY()), .5) << "the least roll";
}

TEST(FindUp, HasNothingToGoByWithoutSurfaces) {
  EXPECT_FALSE(find_up({}).is_seen);
  EXPECT_EQ(find_up({}).up, Vector3d(0, -1, 0));
}

TEST(FindUp, IsNotMisledByWhatIsNeitherLevelNorUpright) {
  std::mt19937 random(3);
  std::normal_distribution<double> any(0, 1);
  const Eigen::Matrix3d camera_from_world = turned(25, 0);
  std::vector<Vector3d> normals;
  for (int i = 0; i < 100; ++i) {
    normals.push_back(camera_from_world * Vector3d(.02 * any(random), 1, .02 * any(random)).normalized());
    normals.push_back(camera_from_world * Vector3d(any(random), .03 * any(random), any(random)).normalized());
    normals.push_back(Vector3d(any(random), any(random), any(random)).normalized());
  }
  EXPECT_LT(angle_deg(find_up(normals).up, camera_from_world * -Vector3d::UnitY()), .7);
}

TEST(PlaneNormals, AreThoseOfStaticSurfacesOnly) {
  DepthPicture picture(room(turned(30, 0)));
  const std::size_t all = plane_normals(picture.view()).size();
  EXPECT_GT(all, 300U);
  picture.view().movable = cv::Mat1b(picture.view().depth_m.size(), 0);
  picture.view().movable.colRange(0, picture.view().depth_m.cols / 2) = 255;
  const std::size_t right = plane_normals(picture.view()).size();
  EXPECT_LT(right, all * 6 / 10);
  EXPECT_GT(right, all * 3 / 10);
}

TEST(PlaneNormals, AreNotMadeOfBallsOrNothing) {
  DepthPicture picture(room(turned(0, 0)));
  cv::Mat1f& depth = picture.view().depth_m;
  for (int row = 0; row < depth.rows; ++row)
    for (int column = 0; column < depth.cols; ++column)
      depth(row, column) = 1 + .1F * static_cast<float>(std::cos(column * .4) * std::cos(row * .4));
  EXPECT_TRUE(plane_normals(picture.view()).empty());
  depth = 0.F;
  EXPECT_TRUE(plane_normals(picture.view()).empty());
}

TEST(LevelPose, HasZUpAndXAhead) {
  const Eigen::Matrix3d camera_from_world = turned(30, 10);
  const geometry::Pose map_from_camera = level_pose(camera_from_world * -Vector3d::UnitY());
  EXPECT_EQ(map_from_camera.translation(), Vector3d::Zero());
  EXPECT_NEAR(map_from_camera.linear().determinant(), 1, 1e-12);
  const Vector3d up = map_from_camera.linear() * camera_from_world * -Vector3d::UnitY();
  EXPECT_LT(angle_deg(up, Vector3d::UnitZ()), 1e-6);
  const Vector3d ahead = map_from_camera.linear() * Vector3d::UnitZ();
  EXPECT_GT(ahead.x(), .5);
  EXPECT_NEAR(ahead.y(), 0, 1e-12);
}

TEST(LevelPose, OfACameraThatLooksStraightDownHasItsUpperEdgeAhead) {
  const geometry::Pose map_from_camera = level_pose(Vector3d(0, 0, -1));
  EXPECT_LT(angle_deg(map_from_camera.linear() * Vector3d(0, -1, 0), Vector3d::UnitX()), 1e-6);
  EXPECT_LT(angle_deg(map_from_camera.linear() * Vector3d(0, 0, 1), -Vector3d::UnitZ()), 1e-6);
}

}  // namespace
}  // namespace rds::tracker
