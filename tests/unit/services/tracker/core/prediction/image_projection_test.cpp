// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/prediction/image_projection.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "services/transformer/core/box_transform.hpp"
#include "tests/unit/services/tracker/core/prediction/scene.hpp"

namespace rds::tracker::prediction {
namespace {

using geometry::Box2;
using geometry::Pose;

void expect_near(const Box2& a, const Box2& b, double tolerance_px) {
  EXPECT_NEAR(a.x0, b.x0, tolerance_px);
  EXPECT_NEAR(a.y0, b.y0, tolerance_px);
  EXPECT_NEAR(a.x1, b.x1, tolerance_px);
  EXPECT_NEAR(a.y1, b.y1, tolerance_px);
}

Pose random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond rotation(normal(random), normal(random), normal(random), normal(random));
  return geometry::make_pose({normal(random), normal(random), normal(random)}, rotation);
}

geometry::CameraModel distorted_camera() {  // the published model of TUM's freiburg1
  geometry::CameraModel camera = scene::camera();
  camera.fx = 517.3;
  camera.fy = 516.5;
  camera.cx = 318.6;
  camera.cy = 255.3;
  camera.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
  return camera;
}

TEST(ImageProjection, GivesTheDetectionsBoxBackFromAnyCameraPose) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> left(0, 300);
  std::uniform_real_distribution<double> side(20, 180);
  for (const auto& camera : {scene::camera(), distorted_camera()})
    for (int i = 0; i < 200; ++i) {
      const double x = left(random);
      const double y = left(random) * 0.9;
      const Box2 box{x, y, x + side(random), y + side(random)};
      const Pose map_from_camera = random_pose(random);
      const auto volume = transformer::box_in_map(box, 0.5 + 0.02 * i, "person", map_from_camera, camera);
      ASSERT_TRUE(volume);
      const auto back = to_image(*volume, map_from_camera.inverse(), camera);
      ASSERT_TRUE(back);
      expect_near(back->box, box, 0.5);
    }
}

TEST(ImageProjection, GivesAWholePictureBackToTheEdges) {
  for (const auto& camera : {scene::camera(), distorted_camera()}) {
    const auto volume = transformer::box_in_map({0, 0, 640, 480}, 1.0, "person", Pose::Identity(), camera);
    ASSERT_TRUE(volume);
    expect_near(image_box(*volume, Pose::Identity(), camera).value_or(Box2{}), {0, 0, 640, 480}, 1);
  }
}

TEST(ImageProjection, KeepsTheWidthOfAPersonThatTheCameraWalksAround) {
  const auto person = scene::see_person({0, 0, 3}, Pose::Identity());
  ASSERT_TRUE(person);
  const double width = image_box(person->box, Pose::Identity(), scene::camera())->width();
  const Eigen::AngleAxisd turn(1.2, Eigen::Vector3d::UnitY());
  const Pose orbit = Eigen::Translation3d(0, 0, 3) * turn * Eigen::Translation3d(0, 0, -3);
  const auto seen = image_box(person->box, orbit.inverse(), scene::camera());
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->width(), width, 1e-6);
}

TEST(ImageProjection, SwapsWidthAndHeightWhenTheCameraRollsByAQuarter) {
  const auto person = scene::see_person({0, 0, 3}, Pose::Identity());
  ASSERT_TRUE(person);
  const Pose rolled(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  const auto seen = image_box(person->box, rolled.inverse(), scene::camera());
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->width(), 0.9 * 500 / 3, 1e-6);
  EXPECT_NEAR(seen->height(), 0.5 * 500 / 3, 1e-6);
}

TEST(ImageProjection, RegionReachesOverTheThicknessAndTheMargins) {
  const auto person = scene::see_person({0, 0, 3}, Pose::Identity());
  ASSERT_TRUE(person);
  const auto seen = to_image(person->box, Pose::Identity(), scene::camera());
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->region.box_px.x0, seen->box.x0 - kRegionMarginPx, 1e-9);
  EXPECT_NEAR(seen->region.box_px.y1, seen->box.y1 + kRegionMarginPx, 1e-9);
  EXPECT_NEAR(seen->region.min_depth_m, 3 - 0.3 - kRegionMarginM, 1e-6);
  EXPECT_NEAR(seen->region.max_depth_m, 3 + 0.3 + kRegionMarginM, 1e-6);
}

TEST(ImageProjection, ReachWidensABoxByAShareWithinThePicture) {
  const geometry::CameraModel camera = scene::camera();
  EXPECT_EQ(with_reach({100, 200, 200, 300}, 0.1, camera), (geometry::Box2{90, 190, 210, 310}));
  EXPECT_EQ(with_reach({100, 200, 200, 300}, 0, camera), (geometry::Box2{100, 200, 200, 300}));
  const double w = camera.width;
  EXPECT_EQ(with_reach({2, 200, w - 2, 300}, 0.1, camera), (geometry::Box2{0, 190, w, 310}));
}

TEST(ImageProjection, SeesNothingBehindTheCameraOrBesideThePicture) {
  const auto person = scene::see_person({0, 0, 3}, Pose::Identity());
  ASSERT_TRUE(person);
  const Pose behind(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()));
  EXPECT_FALSE(to_image(person->box, behind, scene::camera()));
  const Pose aside(Eigen::Translation3d(5, 0, 0));
  EXPECT_FALSE(to_image(person->box, aside, scene::camera()));
}

TEST(ImageProjection, NamesTheSidesAtWhichThePictureCutsABoxOff) {
  const auto volume =
      transformer::box_in_map({0, 100, 300, 480}, 2, "person", Pose::Identity(), scene::camera());
  ASSERT_TRUE(volume);
  const CutSides cut = cut_sides(*volume, Pose::Identity(), scene::camera(), 5);
  EXPECT_TRUE(cut.left);
  EXPECT_TRUE(cut.bottom);
  EXPECT_FALSE(cut.right);
  EXPECT_FALSE(cut.top);
}

TEST(ImageProjection, SurvivesNumbersThatAreNone) {
  const auto person = scene::see_person({0, 0, 3}, Pose::Identity());
  ASSERT_TRUE(person);
  Pose broken = Pose::Identity();
  broken.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(to_image(person->box, broken, scene::camera()));
  auto box = person->box;
  box.size.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(to_image(box, Pose::Identity(), scene::camera()));
}

}  // namespace
}  // namespace rds::tracker::prediction
