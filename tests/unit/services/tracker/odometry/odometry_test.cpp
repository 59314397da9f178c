// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/odometry/odometry.hpp"

#include <random>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace rds::tracker {
namespace {

using geometry::Pose;

constexpr std::int64_t kMs = 1'000'000;
const FrameNames kNames{"map", "odom", "base_link"};

Pose at(double x, double y, double z, double turn_rad = 0) {
  return geometry::make_pose({x, y, z},
                             Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitY())));
}

RobotFrames frames_of(const geometry::TransformTree& tree, const std::string& camera = "optical") {
  return robot_frames(tree, kNames, camera, 0);
}

geometry::TransformTree robot_with_a_camera() {
  geometry::TransformTree tree;
  tree.set_static("base_footprint", "base_link", at(0, 0, 0.1));
  tree.set_static("base_link", "camera_link", at(0.2, 0, 0.5, 0.3));
  tree.set_static("camera_link", "optical", at(0, 0.02, 0));
  return tree;
}

TEST(RobotFrames, OfACameraWithoutTreeAreTheCamera) {
  const RobotFrames frames = frames_of({}, "zed_left_optical_frame");
  EXPECT_EQ(frames.body, "zed_left_optical_frame");
  EXPECT_EQ(frames.child, "zed_left_optical_frame");
  EXPECT_TRUE(frames.map_to_odom_is_ours && frames.odom_to_body_is_ours);
}

TEST(RobotFrames, HangTheRootOfTheTreeBelowOdomAndTellOfTheBase) {
  const RobotFrames frames = frames_of(robot_with_a_camera());
  EXPECT_EQ(frames.body, "base_footprint") << "base_link has a parent already";
  EXPECT_EQ(frames.child, "base_link");
  EXPECT_TRUE(frames.child_from_camera.isApprox(at(0.2, 0, 0.5, 0.3) * at(0, 0.02, 0), 1e-12));
  EXPECT_TRUE(frames.body_from_camera.isApprox(at(0, 0, 0.1) * frames.child_from_camera, 1e-12));
}

TEST(RobotFrames, OfACircleThatSomebodyPublishesAreFoundAllTheSame) {
  geometry::TransformTree tree;
  tree.set_static("a", "optical", at(0, 0, 0));
  tree.set_static("b", "a", at(0, 0, 0));
  tree.set_static("a", "b", at(0, 0, 0));
  tree.set_static("a", "odom", at(0, 0, 0));
  EXPECT_FALSE(frames_of(tree).body.empty());
}

TEST(RobotFrames, LeaveOdomToWheelOdometry) {
  geometry::TransformTree tree = robot_with_a_camera();
  tree.set("odom", "base_footprint", 0, at(3, 0, 1));
  const RobotFrames frames = frames_of(tree);
  EXPECT_FALSE(frames.odom_to_body_is_ours);
  EXPECT_TRUE(frames.map_to_odom_is_ours);
  EXPECT_EQ(frames.body, "base_footprint");
  ASSERT_TRUE(frames.odom_from_camera);
  EXPECT_TRUE(frames.odom_from_camera->isApprox(at(3, 0, 1) * frames.body_from_camera, 1e-12));
}

TEST(RobotFrames, LeaveTheMapToALocalisation) {
  geometry::TransformTree tree = robot_with_a_camera();
  tree.set("map", "odom", 0, at(0, 0, 0));
  EXPECT_FALSE(frames_of(tree).map_to_odom_is_ours);
  EXPECT_TRUE(frames_of(tree).odom_to_body_is_ours);
  geometry::TransformTree direct = robot_with_a_camera();
  direct.set("map", "base_footprint", 0, at(0, 0, 0));
  EXPECT_FALSE(frames_of(direct).map_to_odom_is_ours || frames_of(direct).odom_to_body_is_ours)
      << "its parent is map";
}

TrackedPose pose(std::int64_t ms, const Pose& map_from_camera, bool is_continuous = true) {
  return {ms * kMs, map_from_camera, 1e6 * Matrix6::Identity(), is_continuous};
}

TEST(Odometry, OdomIsContinuousOverALoopAndARelocalisation) {
  const RobotFrames frames = frames_of(robot_with_a_camera());
  Odometry odometry;
  const OdometryStep before = odometry.step(pose(0, at(1, 0, 0)), frames);
  odometry.move_map(at(0, 0, 5, 0.2));  // a loop corrects the map
  const OdometryStep after_loop = odometry.step(pose(33, at(0, 0, 5, 0.2) * at(1.01, 0, 0)), frames);
  EXPECT_LT((after_loop.odom_from_body->translation() - before.odom_from_body->translation()).norm(), 0.0101);
  const OdometryStep found = odometry.step(pose(900, at(-7, 0, 2, 1), false), frames);
  EXPECT_TRUE(found.odom_from_body->isApprox(*after_loop.odom_from_body, 1e-9))
      << "map → odom takes the jump";
  EXPECT_TRUE((*found.map_from_odom * *found.odom_from_body * frames.body_from_camera)
                  .isApprox(at(-7, 0, 2, 1), 1e-9));
  odometry.begin_map();
  const OdometryStep next_map = odometry.step(pose(950, at(0, 0, 0)), frames);
  EXPECT_TRUE(next_map.odom_from_body->isApprox(*after_loop.odom_from_body, 1e-9));
}

TEST(Odometry, ARobotStaysWhereItWasUnderACameraThatTurnedOnItWhileItWasLost) {
  const auto pan = [](double rad) {
    geometry::TransformTree tree;
    tree.set("base_link", "optical", 0, at(0.2, 0, 0.5, rad));
    return frames_of(tree);
  };
  Odometry odometry;
  const OdometryStep before = odometry.step(pose(0, at(1, 0, 0)), pan(0));
  const OdometryStep found = odometry.step(pose(3000, at(5, 0, 0, 0.8), false), pan(0.8));
  EXPECT_TRUE(found.odom_from_body->isApprox(*before.odom_from_body, 1e-9));
  EXPECT_TRUE((*found.map_from_odom * *found.odom_from_body * pan(0.8).body_from_camera)
                  .isApprox(at(5, 0, 0, 0.8), 1e-9));
}

TEST(Odometry, GoesOnInASubmapThatHasNoPlaceInTheMap) {
  const RobotFrames frames = frames_of(robot_with_a_camera());
  Odometry odometry;
  const OdometryStep before = odometry.step(pose(0, at(1, 0, 0)), frames);
  TrackedPose beside = pose(5000, at(0, 0, 0), false);
  beside.is_placed = false;
  const OdometryStep first = odometry.step(beside, frames);
  EXPECT_FALSE(first.map_from_odom);
  EXPECT_TRUE(first.odom_from_body->isApprox(*before.odom_from_body, 1e-9));
  odometry.move_map(at(4, 1, 0, 0.3));  // the submap is joined
  const OdometryStep joined = odometry.step(pose(5033, at(4, 1, 0, 0.3)), frames);
  EXPECT_TRUE(joined.odom_from_body->isApprox(*before.odom_from_body, 1e-9));
  ASSERT_TRUE(joined.map_from_odom);
  EXPECT_TRUE((*joined.map_from_odom * *joined.odom_from_body * frames.body_from_camera)
                  .isApprox(at(4, 1, 0, 0.3), 1e-9));
}

TEST(Odometry, CorrectsTheMapAboveWheelOdometry) {
  geometry::TransformTree tree = robot_with_a_camera();
  tree.set("odom", "base_footprint", 0, at(3, 0, 1));
  const RobotFrames frames = frames_of(tree);
  const OdometryStep step = Odometry().step(pose(0, at(1, 2, 3, 0.4)), frames);
  EXPECT_FALSE(step.odom_from_body);
  ASSERT_TRUE(step.map_from_odom);
  EXPECT_TRUE((*step.map_from_odom * at(3, 0, 1) * frames.body_from_camera).isApprox(at(1, 2, 3, 0.4), 1e-9));
  EXPECT_TRUE(step.is_in_map) << "odom is not ours to tell of";
}

TEST(Odometry, TellsTheSpeedOfTheBaseInItsOwnFrame) {
  const RobotFrames frames = frames_of(robot_with_a_camera());
  Odometry odometry;
  Twist speed;
  speed << 0.5, 0.1, 0, 0, 0.4, 0;
  OdometryStep step;
  Pose base = at(1, 2, 3, 0.7);
  for (int i = 0; i < 20; ++i) {
    step = odometry.step(pose(33 * i, base * frames.child_from_camera), frames);
    if (i == 0) {
      EXPECT_GT(step.twist_covariance(0, 0), 0.5) << "not known yet";
    }
    base = base * se3_exp(0.033 * speed);
  }
  EXPECT_TRUE(step.twist.isApprox(speed, 0.01)) << step.twist.transpose();
  EXPECT_LT(step.twist_covariance(0, 0), 0.5);
}

/// Of poses that are noisy as their information says, the normalised error squared has the mean 6: in the
/// base's frame, and about the axes of odom.
TEST(Odometry, CovarianceFitsErrorsOfThePose) {
  const RobotFrames frames = frames_of(robot_with_a_camera());
  Twist sigma;
  sigma << 0.002, 0.003, 0.006, 0.002, 0.001, 0.004;
  Matrix6 information = Matrix6::Zero();
  for (int i = 0; i < 6; ++i) information(i, i) = 1 / (sigma[i] * sigma[i]);
  const Pose truth = at(1, -2, 0.5, 1.1);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double sum = 0;
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    Twist error;
    for (int i = 0; i < 6; ++i) error[i] = sigma[i] * normal(random);
    const OdometryStep step = Odometry().step({0, truth * se3_exp(error), information, true}, frames);
    const Pose base = truth * frames.child_from_camera.inverse();
    Twist off;
    off << step.parent_from_child.translation() - base.translation(),
        se3_log(geometry::make_pose({0, 0, 0}, Eigen::Quaterniond(step.parent_from_child.linear() *
                                                                  base.linear().transpose())))
            .tail<3>();
    sum += off.dot(step.pose_covariance.ldlt().solve(off));
  }
  EXPECT_NEAR(sum / kRuns, 6, 0.3);
}

TEST(Odometry, TellsTheCovarianceOfAPoseThatIsCarriedOn) {
  const RobotFrames frames = frames_of(robot_with_a_camera());
  TrackedPose carried = pose(0, at(1, 2, 0));
  carried.covariance = 0.04 * Matrix6::Identity();
  const OdometryStep step = Odometry().step(carried, frames);
  const Eigen::VectorXd variances = step.pose_covariance.diagonal();
  EXPECT_NEAR(variances.tail(3).sum(), 3 * 0.04, 1e-9);
  EXPECT_GT(variances.head(3).sum(), 3 * 0.04) << "with the base's lever";
}

TEST(Odometry, AddsTheCovarianceOfTheMapToThatOfThePoseAndNotToThatOfTheSpeed) {
  const RobotFrames frames = frames_of({});
  Odometry in_exact_map, in_map;
  OdometryStep exact, uncertain;
  for (int i = 0; i < 10; ++i) {
    TrackedPose still = pose(33 * i, at(0, 0, 0));
    exact = in_exact_map.step(still, frames);
    still.map_covariance = 4e-4 * Matrix6::Identity();
    uncertain = in_map.step(still, frames);
  }
  const Matrix6 more = uncertain.pose_covariance - exact.pose_covariance;
  EXPECT_TRUE(more.isApprox(4e-4 * Matrix6::Identity(), 1e-9));
  EXPECT_EQ(uncertain.twist_covariance, exact.twist_covariance);
}

TEST(Odometry, IsNeverCertain) {
  for (const Matrix6& information : {Matrix6(Matrix6::Zero()), Matrix6(1e4 * Matrix6::Identity())}) {
    const RobotFrames frames = frames_of(robot_with_a_camera());
    const Matrix6 covariance = Odometry().step({0, at(0, 0, 0), information, true}, frames).pose_covariance;
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix6>(covariance).eigenvalues().minCoeff(), 1e-12);
    EXPECT_TRUE(covariance.isApprox(covariance.transpose()));
  }
}

}  // namespace
}  // namespace rds::tracker
