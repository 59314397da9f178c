// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/core/point_registration.hpp"

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

namespace rds::loop_closer {
namespace {

using geometry::Pose;

const Pose kTruth = geometry::make_pose(
    {0.3, -0.1, 0.2}, Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, -1).normalized())));

Eigen::Vector3d random_point(cv::RNG& rng) {
  return {rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), rng.uniform(1.5, 4.0)};
}

std::vector<PointPair> pairs_with_outliers(int count, double outlier_share, double noise_m) {
  cv::RNG rng(3);
  std::vector<PointPair> pairs;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d query = random_point(rng);
    Eigen::Vector3d candidate =
        kTruth * query + Eigen::Vector3d(rng.gaussian(noise_m), rng.gaussian(noise_m), rng.gaussian(noise_m));
    if (rng.uniform(0.0, 1.0) < outlier_share) candidate = random_point(rng);
    pairs.push_back({query, candidate});
  }
  return pairs;
}

TEST(PointRegistration, RecoversTheTransformWithFiftyPercentOutliers) {
  const auto pairs = pairs_with_outliers(200, 0.5, 0.005);
  const auto found = register_points(pairs);
  ASSERT_TRUE(found);
  const Pose error = found->candidate_from_query.inverse() * kTruth;
  EXPECT_LT(error.translation().norm(), 0.005);
  EXPECT_LT(geometry::rotation_angle_rad(error.linear()), 0.003);
  EXPECT_NEAR(static_cast<double>(found->inliers.size()), 100, 20);
}

TEST(PointRegistration, GivesTheSameAnswerEveryTime) {
  const auto pairs = pairs_with_outliers(200, 0.5, 0.005);
  const auto first = register_points(pairs);
  const auto second = register_points(pairs);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->candidate_from_query.matrix(), second->candidate_from_query.matrix());
  EXPECT_EQ(first->inliers, second->inliers);
}

TEST(PointRegistration, FindsNothingInPairsWithoutGeometry) {
  EXPECT_FALSE(register_points(pairs_with_outliers(300, 1.0, 0)));
}

TEST(PointRegistration, FindsNothingInTooFewPairsOrPointsInOneSpot) {
  EXPECT_FALSE(register_points({}));
  EXPECT_FALSE(register_points(pairs_with_outliers(19, 0, 0)));
  const std::vector<PointPair> spot(100, PointPair{{0, 0, 2}, {0.1, 0, 2}});
  EXPECT_FALSE(register_points(spot));
}

TEST(PointRegistration, PointsAgreeMoreLooselyTheFartherTheyAre) {
  EXPECT_TRUE(agree({0, 0, 3.0}, {0, 0, 3.3}));
  EXPECT_FALSE(agree({0, 0, 1.0}, {0, 0, 1.3}));
  EXPECT_FALSE(agree({0, 0, 1.0}, {0.02, 0, 1.0}));
  EXPECT_FALSE(agree({0, 0, -1.0}, {0, 0, -1.0}));
  EXPECT_FALSE(agree({0, 0, std::nan("")}, {0, 0, 1.0}));
}

}  // namespace
}  // namespace rds::loop_closer
