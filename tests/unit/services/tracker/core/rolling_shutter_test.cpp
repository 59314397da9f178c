// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/rolling_shutter.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "services/tracker/core/local_mapping.hpp"
#include "services/tracker/core/mapping_exchange.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

constexpr double kReadout = 0.025;  // s

/// A hand-held camera's: 0.3 m/s and 50 degrees per second.
Twist quick_motion() {
  Twist velocity;
  velocity << 0.2, -0.15, 0.15, 0.6, -0.6, 0.2;
  return velocity;
}

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

  ShutterMotion motion{quick_motion(), kReadout};
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
       {ShutterMotion{quick_motion(), 0}, ShutterMotion{Twist::Zero(), kReadout}}) {
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

/// Keyframes at one place and another, each with another motion, as they are before anything is known.
class MovingKeyframes {
 public:
  explicit MovingKeyframes(double readout_s) {
    std::vector<PointId> ids(points_.size(), kNoId);
    for (int k = 0; k < 8; ++k) {
      const Pose truth = test::pose(0.05 * k, 0, 0, -0.02 * k);
      const Twist velocity = (k % 3 - 1.0) * quick_motion();
      const auto view = test::view_of(points_, truth, 0.3, random_, {velocity, readout_s});
      Keyframe& keyframe = map_.add_keyframe(k, truth, view.features);
      keyframe.motion.velocity = velocity;
      for (std::uint32_t f = 0; f < view.point.size(); ++f) {
        PointId& p = ids[view.point[f]];
        if (p == kNoId)
          p = map_.add_point(truth * view.features->point_in_camera(f), keyframe.id, f).id;
        else
          map_.observe(p, keyframe.id, f);
      }
      map_.update_covisibility(keyframe.id);
    }
  }

  [[nodiscard]] LocalMappingJob job() const {
    LocalMappingJob made = make_mapping_job(map_, 7, LocalMappingConfig{});
    made.pyramid = ScalePyramid(8, 1.2);
    made.calibrate_readout = true;
    return made;
  }

 private:
  std::mt19937 random_{5};
  std::vector<Eigen::Vector3d> points_ = test::random_points(400, random_);
  SlamMap map_{MapConfig{}, ScalePyramid(8, 1.2)};
};

TEST(ReadoutInBundleAdjustment, IsFound) {
  for (const double readout_s : {-0.02, 0.0, kReadout}) {
    const auto result = run_local_mapping(MovingKeyframes(readout_s).job(), LocalMappingConfig{});
    EXPECT_NEAR(result.readout_s, readout_s, 0.002);
    EXPECT_GT(result.readout_information, 1e6);
  }
}

TEST(ReadoutInBundleAdjustment, StaysIfItIsNotToBeFound) {
  LocalMappingJob job = MovingKeyframes(kReadout).job();
  job.calibrate_readout = false;
  job.readout_s = 0.01;
  const auto result = run_local_mapping(job, LocalMappingConfig{});
  EXPECT_EQ(result.readout_s, 0.01);
  EXPECT_EQ(result.readout_information, 0);
}

TEST(ReadoutCalibrationTest, GoesTowardsWhatHasMoreInformation) {
  ReadoutCalibration calibration(RollingShutterConfig{});
  EXPECT_EQ(calibration.readout_s(), 0);
  calibration.update(0.02, 1);
  EXPECT_LT(calibration.readout_s(), 1e-6);
  for (int i = 0; i < 30; ++i) calibration.update(0.02, 1e8);
  EXPECT_NEAR(calibration.readout_s(), 0.02, 1e-4);
}

TEST(ReadoutCalibrationTest, StaysPossible) {
  ReadoutCalibration calibration(RollingShutterConfig{});
  for (int i = 0; i < 30; ++i) calibration.update(7, 1e8);
  EXPECT_EQ(calibration.readout_s(), 0.05);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  calibration.update(nan, 1e8);
  calibration.update(0.01, nan);
  EXPECT_EQ(calibration.readout_s(), 0.05);
}

}  // namespace
}  // namespace rds::tracker
