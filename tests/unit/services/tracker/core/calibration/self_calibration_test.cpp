// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/calibration/self_calibration.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "services/tracker/core/map/covisibility.hpp"
#include "services/tracker/core/mapping/local_mapping.hpp"
#include "services/tracker/core/mapping/mapping_exchange.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

using Observations = std::vector<std::vector<ObservationDerivatives>>;  // per point

constexpr std::size_t kCameras = 3;

Observations random_observations(std::size_t points) {
  std::srand(5);  // of Eigen's Random()
  Observations all(points);
  for (auto& of_point : all)
    for (std::size_t c = 0; c < kCameras; ++c) {
      ObservationDerivatives o;
      o.camera = c;
      o.residual.setRandom();
      o.by_pose.setRandom();
      o.by_point.setRandom();
      o.by_imaging.setRandom();
      of_point.push_back(o);
    }
  return all;
}

/// All unknowns at once: imaging, poses of cameras 1 and 2, points.
ImagingEstimate dense_estimate(const Observations& all) {
  const auto columns = static_cast<Eigen::Index>(2 + 6 * (kCameras - 1) + 3 * all.size());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(columns, columns);
  normal.diagonal().segment(2, 12).setConstant(1e-2);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(columns);
  for (std::size_t p = 0; p < all.size(); ++p)
    for (const ObservationDerivatives& o : all[p]) {
      Eigen::MatrixXd row = Eigen::MatrixXd::Zero(3, columns);
      row.leftCols<2>() = o.by_imaging;
      if (o.camera > 0) row.middleCols<6>(static_cast<Eigen::Index>(2 + 6 * (o.camera - 1))) = o.by_pose;
      row.middleCols<3>(static_cast<Eigen::Index>(14 + 3 * p)) = o.by_point;
      normal += row.transpose() * row;
      gradient += row.transpose() * o.residual;
    }
  const Eigen::MatrixXd covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(columns, columns));
  const Eigen::Matrix2d of_imaging = covariance.topLeftCorner<2, 2>();
  return {-(covariance * gradient).head<2>(), of_imaging.llt().solve(Eigen::Matrix2d::Identity())};
}

TEST(ImagingEstimatorTest, IsAGaussNewtonStepOfTheWholeBundle) {
  const Observations all = random_observations(20);
  ImagingEstimator estimator(kCameras);
  for (const auto& of_point : all) estimator.add_point(of_point);
  const ImagingEstimate found = estimator.estimate(Imaging(0.5, 2));
  const ImagingEstimate expected = dense_estimate(all);
  EXPECT_LT((found.value - Imaging(0.5, 2) - expected.value).norm(), 1e-9);
  EXPECT_LT((found.information - expected.information).norm(), 1e-9 * expected.information.norm());
}

TEST(ImagingEstimatorTest, KnowsThatItKnowsNothing) {
  for (const std::size_t cameras : {0U, 1U, 4U}) {
    const ImagingEstimate found = ImagingEstimator(cameras).estimate(Imaging(0.01, 1));
    EXPECT_EQ(found.value, Imaging(0.01, 1));
    EXPECT_TRUE(found.information.isZero());
  }
}

/// Keyframes at one place and another, each with another motion, as they are before anything is known.
class MovingKeyframes {
 public:
  /// @param focal_error  factor on the true focal length that the keyframes believe in.
  MovingKeyframes(double readout_s, double focal_error) {
    std::vector<PointId> ids(points_.size(), kNoId);
    geometry::CameraModel believed = test::small_camera();
    believed.fx *= focal_error;
    believed.fy *= focal_error;
    for (int k = 0; k < 8; ++k) {
      const Pose truth = test::pose(0.05 * k, 0, 0.02 * k, -0.03 * k);
      const Twist velocity = (k % 3 - 1.0) * test::quick_motion();
      const auto view = test::view_of(points_, truth, 0.3, random_, {velocity, readout_s});
      Keyframe& keyframe =
          map_.add_keyframe(k, truth, std::make_shared<FeatureSet>(believed, view.features->all()));
      keyframe.motion.velocity = velocity;
      keyframe.given_fx = believed.fx;
      for (std::uint32_t f = 0; f < view.point.size(); ++f) {
        PointId& p = ids[view.point[f]];
        if (p == kNoId)
          p = map_.add_point(truth * keyframe.features->point_in_camera(f), keyframe.id, f).id;
        else
          map_.observe(p, keyframe.id, f);
      }
      update_covisibility(map_, keyframe.id);
    }
  }

  [[nodiscard]] ImagingEstimate estimate() const {
    LocalMappingJob job = make_mapping_job(map_, 7);
    job.pyramid = ScalePyramid(8, 1.2);
    job.given_fx = map_.keyframe(0)->features->camera().fx;
    return run_local_mapping(job).imaging;
  }

 private:
  std::mt19937 random_{5};
  std::vector<Eigen::Vector3d> points_ = test::random_points(400, random_);
  SlamMap map_{ScalePyramid(8, 1.2)};
};

TEST(ImagingInLocalMapping, ReadoutIsFound) {
  for (const double readout_s : {-0.02, 0.0, 0.025}) {
    const ImagingEstimate found = MovingKeyframes(readout_s, 1).estimate();
    EXPECT_NEAR(found.value(0), readout_s, 0.002);
    EXPECT_GT(found.information(0, 0), 1e6);
  }
}

TEST(ImagingInLocalMapping, AWrongFocalLengthIsFound) {
  for (const double error : {0.95, 1.0, 1.06}) {
    const ImagingEstimate found = MovingKeyframes(0, error).estimate();
    const double sigma = std::sqrt(found.information.inverse()(1, 1));
    EXPECT_LT(sigma, 0.02);
    EXPECT_NEAR(found.value(1), 1 / error, 3 * sigma + 0.003) << sigma;
  }
}

ImagingEstimate measured(double readout_s, double focal_scale, double sigma) {
  return {{readout_s, focal_scale}, Eigen::Vector2d(1e6, 1 / (sigma * sigma)).asDiagonal()};
}

SelfCalibration after(int updates, const ImagingEstimate& estimate) {
  SelfCalibration calibration(SelfCalibrationConfig{});
  for (int i = 0; i < updates; ++i) calibration.update(estimate);
  return calibration;
}

TEST(SelfCalibrationTest, GoesTowardsWhatHasMoreInformation) {
  SelfCalibration calibration(SelfCalibrationConfig{});
  EXPECT_EQ(calibration.readout_s(), 0);
  calibration.update({{0.02, 1}, 1e-3 * Eigen::Matrix2d::Identity()});
  EXPECT_EQ(calibration.readout_s(), 0);
  for (int i = 0; i < 30; ++i) calibration.update(measured(0.02, 1, 0.01));
  EXPECT_NEAR(calibration.readout_s(), 0.02, 1e-4);
}

TEST(SelfCalibrationTest, AGlobalShutterStaysOne) {
  SelfCalibration calibration = after(50, measured(0.0008, 1, 0.01));
  EXPECT_EQ(calibration.readout_s(), 0);
}

TEST(SelfCalibrationTest, TheGivenFocalLengthHoldsUntilItIsKnownToBeWrong) {
  EXPECT_EQ(after(50, measured(0, 0.992, 0.001)).focal_scale(), 1);
  EXPECT_EQ(after(1, measured(0, 0.95, 0.03)).focal_scale(), 1);
  EXPECT_NEAR(after(50, measured(0, 0.95, 0.005)).focal_scale(), 0.95, 1e-3);
}

TEST(SelfCalibrationTest, ABundleThatHardlyKnowsIsNotBelieved) {
  SelfCalibration calibration = after(200, measured(0.02, 0.9, 0.02));
  EXPECT_EQ(calibration.focal_scale(), 1);
  EXPECT_NEAR(calibration.readout_s(), 0.02, 1e-3);
}

TEST(SelfCalibrationTest, WhatIsSwitchedOffStaysAsGiven) {
  SelfCalibrationConfig config;
  config.readout = config.focal_length = false;
  config.readout_s = 0.01;
  SelfCalibration calibration(config);
  for (int i = 0; i < 50; ++i) calibration.update(measured(0.03, 0.8, 0.001));
  calibration.begin_with({500, 0.9});
  EXPECT_EQ(calibration.readout_s(), 0.01);
  EXPECT_EQ(calibration.focal_scale(), 1);
}

TEST(SelfCalibrationTest, GoesOnFromASavedMapUnlessItIsAnotherCameras) {
  SelfCalibration calibration(SelfCalibrationConfig{});
  calibration.begin_with({500, 0.5});
  EXPECT_EQ(calibration.focal_scale(), 1);
  calibration.begin_with({500, 0.95});
  EXPECT_EQ(calibration.focal_scale(), 0.95);
}

TEST(SelfCalibrationTest, StaysPossible) {
  SelfCalibration calibration = after(30, measured(7, 9, 0.001));
  EXPECT_EQ(calibration.readout_s(), 0.05);
  EXPECT_EQ(calibration.focal_scale(), 1);  // no bundle that claims 9 is believed
  const double nan = std::numeric_limits<double>::quiet_NaN();
  calibration.update(measured(nan, 1, 0.001));
  calibration.update(measured(0, 1, nan));
  EXPECT_EQ(calibration.readout_s(), 0.05);
}

}  // namespace
}  // namespace rds::tracker
