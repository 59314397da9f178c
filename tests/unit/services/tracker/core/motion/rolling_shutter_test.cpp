// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/motion/rolling_shutter.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr double kReadout = 0.025;  // s

double largest_offset(const std::vector<Feature>& features, const test::SyntheticView& truth,
                      const test::SyntheticView& view) {
  double largest = 0;
  for (std::size_t i = 0; i < features.size(); ++i)
    for (std::size_t t = 0; t < truth.point.size(); ++t)
      if (truth.point[t] == view.point[i])
        largest = std::max(largest, static_cast<double>((features[i].px - (*truth.features)[t].px).norm()));
  return largest;
}

class RollingShutter : public ::testing::Test {
 protected:
  std::mt19937 random{3};
  std::vector<Eigen::Vector3d> points = test::random_points(300, random);
  geometry::CameraModel camera = test::small_camera();
  /// The features of the moving camera, compensated for a motion.
  [[nodiscard]] std::vector<Feature> compensated(const ShutterMotion& known) const {
    std::vector<Feature> features = moving.features->all();
    remove_rolling_shutter(camera, known, features);
    return features;
  }

  ShutterMotion motion{test::quick_motion(), kReadout};
  test::SyntheticView still = test::view_of(points, Pose::Identity(), 0, random);
  test::SyntheticView moving = test::view_of(points, Pose::Identity(), 0, random, motion);
};

TEST_F(RollingShutter, IsRemovedToATenthOfAPixel) {
  ASSERT_GT(largest_offset(moving.features->all(), still, moving), 2.0);
  EXPECT_LT(largest_offset(compensated(motion), still, moving), 0.1);
}

TEST_F(RollingShutter, ADepthFollowsToo) {
  const std::vector<Feature> features = compensated(motion);
  for (std::size_t i = 0; i < features.size(); ++i)
    EXPECT_NEAR(features[i].depth_m, points[moving.point[i]].z(), 1e-3);
}

TEST_F(RollingShutter, AFeatureWithoutDepthFollowsTheRotation) {
  motion.velocity.head<3>().setZero();
  moving = test::view_of(points, Pose::Identity(), 0, random, motion);
  std::vector<Feature> features = moving.features->all();
  for (Feature& f : features) f.depth_m = 0;
  remove_rolling_shutter(camera, motion, features);
  EXPECT_LT(largest_offset(features, still, moving), 0.1);
}

TEST_F(RollingShutter, ThePlaceInThePictureStays) {
  const std::vector<Feature> features = compensated(motion);
  for (std::size_t i = 0; i < features.size(); ++i)
    EXPECT_EQ(features[i].image_px, (*moving.features)[i].image_px);
}

TEST_F(RollingShutter, NothingHappensAtRestOrWithAGlobalShutter) {
  for (const ShutterMotion& none :
       {ShutterMotion{test::quick_motion(), 0}, ShutterMotion{Twist::Zero(), kReadout}}) {
    const std::vector<Feature> features = compensated(none);
    for (std::size_t i = 0; i < features.size(); ++i) EXPECT_EQ(features[i].px, (*moving.features)[i].px);
  }
}

TEST_F(RollingShutter, AProjectionIsNearToWhereTheFeatureIsSeen) {
  for (std::size_t i = 0; i < moving.point.size(); ++i) {
    const Eigen::Vector2d px = project_rolling(camera, motion, points[moving.point[i]]);
    EXPECT_LT((px - (*moving.features)[i].image_px.cast<double>()).norm(), 0.2);  // of up to 6
  }
}

TEST_F(RollingShutter, TheEffectIsTheDerivativeByTheReadoutTime) {
  constexpr double kStep = 1e-4;  // s
  const FeatureSet before(camera, compensated({motion.velocity, kReadout - kStep}));
  const FeatureSet after(camera, compensated({motion.velocity, kReadout + kStep}));
  for (std::size_t i = 0; i < moving.point.size(); ++i) {
    const Eigen::Vector3d numeric = (after.point_in_camera(i) - before.point_in_camera(i)) / (2 * kStep);
    const Eigen::Vector3d effect = shutter_effect(camera, motion.velocity, (*moving.features)[i]);
    EXPECT_LT((numeric + effect).norm(), 0.02 * motion.velocity.norm());
  }
}

}  // namespace
}  // namespace rds::tracker
