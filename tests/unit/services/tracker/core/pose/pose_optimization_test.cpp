// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/pose_optimization.hpp"

#include <random>

#include <gtest/gtest.h>

#include "services/tracker/core/motion/se3.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker {
namespace {

const ObservationModel kModel(test::small_camera());
const ScalePyramid kPyramid(8, 1.2);

struct Problem {
  Pose camera_from_map = se3_exp((Twist() << 0.2, -0.1, 0.15, 0.1, -0.2, 0.3).finished());
  std::vector<PointObservation> observations;
};

Problem make_problem(double outlier_share, double noise_px) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0, noise_px);
  std::uniform_real_distribution<double> anywhere(0, 240);
  Problem problem;
  for (const Eigen::Vector3d& p : test::random_points(300, random)) {
    const Eigen::Vector3d in_camera = problem.camera_from_map * p;
    Feature feature;
    feature.px = (kModel.project(in_camera) + Eigen::Vector2d(noise(random), noise(random))).cast<float>();
    if (problem.observations.size() % 3 != 0) feature.depth_m = static_cast<float>(in_camera.z());
    if (static_cast<double>(problem.observations.size()) < 300 * outlier_share)
      feature.px = Eigen::Vector2d(anywhere(random), anywhere(random)).cast<float>();
    problem.observations.push_back({p, kModel.measurement(feature, kPyramid)});
  }
  return problem;
}

TEST(PoseOptimization, RecoversPoseWithThirtyPercentOutliers) {
  const Problem problem = make_problem(0.3, 0.5);
  const Pose start =
      se3_exp((Twist() << 0.03, 0.02, -0.03, 0.02, 0.02, -0.02).finished()) * problem.camera_from_map;
  const auto result = optimize_pose(kModel, problem.observations, start);
  const Twist error = se3_log(result.camera_from_map * problem.camera_from_map.inverse());
  EXPECT_TRUE(error.head<3>().norm() < 0.003) << error.transpose();
  EXPECT_TRUE(error.tail<3>().norm() < 0.002) << error.transpose();
  EXPECT_NEAR(result.inliers, 210, 12);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_FALSE(result.inlier[i]);
}

TEST(PoseOptimization, FollowsTheManyThatMoveOnlyIfTheyCountAsMuch) {
  // Two thirds of the points are on something that has moved by 10 cm.
  Problem problem = make_problem(0, 0.3);
  for (std::size_t i = 0; i < 200; ++i) problem.observations[i].point_in_map -= Eigen::Vector3d(0.1, 0, 0);
  const auto error_m = [&] {
    const Pose found =
        optimize_pose(kModel, problem.observations, problem.camera_from_map)
            .camera_from_map;
    return (found * problem.camera_from_map.inverse()).translation().norm();
  };
  EXPECT_GT(error_m(), 0.05);
  for (std::size_t i = 0; i < 200; ++i) problem.observations[i].weight = 0.1;
  EXPECT_LT(error_m(), 0.005);
}

TEST(PoseOptimization, LeavesThePoseWhereNothingCanBeSaid) {
  const auto result = optimize_pose(kModel, {}, test::pose(1, 2, 3));
  EXPECT_EQ(result.inliers, 0);
  EXPECT_TRUE(result.camera_from_map.isApprox(test::pose(1, 2, 3)));
}

TEST(PoseOptimization, SurvivesPointsBehindTheCamera) {
  std::vector<PointObservation> observations(10);
  for (auto& o : observations) o.point_in_map = {0, 0, -2};
  const auto result = optimize_pose(kModel, observations, Pose::Identity());
  EXPECT_EQ(result.inliers, 0);
  EXPECT_TRUE(geometry::is_finite(result.camera_from_map));
}

TEST(ObservationModel, JacobianEqualsTheNumericOne) {
  Feature feature;
  feature.px = {100, 80};
  feature.depth_m = 2.2F;
  feature.level = 3;
  const Measurement m = kModel.measurement(feature, kPyramid);
  const Eigen::Vector3d p(0.3, -0.4, 2);
  const Eigen::Matrix3d analytic = kModel.jacobian(p, m);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
    const Eigen::Vector3d numeric =
        (kModel.residual(p + step, m) - kModel.residual(p - step, m)) / (2 * kStep);
    EXPECT_TRUE((numeric - analytic.col(k)).norm() < 1e-5) << k;
  }
}

TEST(Se3, LogarithmInvertsExponential) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.5, 1.5);
  for (int i = 0; i < 50; ++i) {
    Twist twist;
    for (int k = 0; k < 6; ++k) twist(k) = any(random);
    EXPECT_TRUE((se3_log(se3_exp(twist)) - twist).norm() < 1e-9) << twist.transpose();
    EXPECT_TRUE((se3_exp(-twist) * se3_exp(twist)).isApprox(Pose::Identity(), 1e-9));
  }
  EXPECT_TRUE(se3_log(Pose::Identity()).norm() < 1e-12);
}

}  // namespace
}  // namespace rds::tracker
