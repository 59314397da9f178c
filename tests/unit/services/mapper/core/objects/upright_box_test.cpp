// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/upright_box.hpp"

#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace rds::mapper {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
const Eigen::Vector3d kCenter(2, -1, 0.4);
const Eigen::Vector3d kSize(1.4, 0.8, 0.7);
const double kHalfVoxel = Eigen::Vector3d::Constant(0.0251).norm();  // in each direction

/// Centres of 5-cm voxels that the sides and the top of a box lie in.
std::vector<Eigen::Vector3d> shell(double yaw_rad, const Eigen::Vector3d& size = kSize) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  const Eigen::AngleAxisd turn(yaw_rad, Eigen::Vector3d::UnitZ());
  std::vector<Eigen::Vector3d> voxels;
  for (int i = 0; i < 4000; ++i) {
    Eigen::Vector3d p(uniform(random), uniform(random), uniform(random));
    const int face = i % 5;  // not the lower one
    p[face / 2] = face % 2 == 0 ? 0.5 : -0.5;
    const Eigen::Vector3d in_map = kCenter + turn * p.cwiseProduct(size).eval();
    voxels.emplace_back(((in_map / 0.05).array().floor() + 0.5) * 0.05);
  }
  return voxels;
}

double angle_between_axes(double a, double b) {
  return std::abs(std::remainder(a - b, std::numbers::pi));
}

TEST(UprightBox, FindsABoxHoweverItIsTurned) {
  for (int degrees = -90; degrees < 90; degrees += 7) {
    const UprightBox found = upright_box(shell(degrees * kDegree), Eigen::Matrix3d::Identity(), 0.05);
    EXPECT_LT(angle_between_axes(found.yaw_rad, degrees * kDegree), 4 * kDegree) << degrees;
    EXPECT_LT((found.box.center() - kCenter).norm(), kHalfVoxel) << degrees;
    EXPECT_LT((found.box.size - kSize).cwiseAbs().maxCoeff(), 0.07) << degrees;
    EXPECT_GT(found.yaw_rad, -90.5 * kDegree);
    EXPECT_LE(found.yaw_rad, 90 * kDegree + 1e-9);
  }
}

TEST(UprightBox, AFewVoxelsBesideItDoNotMatter) {
  auto voxels = shell(30 * kDegree);
  for (int i = 0; i < 30; ++i) voxels.emplace_back(kCenter + Eigen::Vector3d(0.4 + 0.01 * i, -0.9, 0));
  const UprightBox found = upright_box(voxels, Eigen::Matrix3d::Identity(), 0.05);
  EXPECT_LT(angle_between_axes(found.yaw_rad, 30 * kDegree), 3 * kDegree);
  EXPECT_LT((found.box.size - kSize).cwiseAbs().maxCoeff(), 0.07);
}

TEST(UprightBox, StandsUprightWhereverUpIs) {
  const Eigen::Matrix3d map_from_level =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(0.1, -1, 0.2))
          .toRotationMatrix();
  const auto level = shell(25 * kDegree);
  std::vector<Eigen::Vector3d> in_map;
  for (const auto& p : level) in_map.emplace_back(map_from_level * p);
  const UprightBox expected = upright_box(level, Eigen::Matrix3d::Identity(), 0.05);
  const UprightBox found = upright_box(in_map, map_from_level, 0.05);
  EXPECT_NEAR(found.yaw_rad, expected.yaw_rad, 1e-9);
  EXPECT_TRUE(found.box.size.isApprox(expected.box.size, 1e-9));
  EXPECT_TRUE(found.box.center().isApprox(map_from_level * expected.box.center(), 1e-9));
  EXPECT_TRUE(found.box.map_from_box.linear().col(2).isApprox(map_from_level.col(2), 1e-9));
  EXPECT_TRUE(geometry::is_valid(found.box));
}

TEST(UprightBox, CornersOfABoxAlongTheAxesGiveThatBox) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 2 : 1, i & 2 ? 4 : 1, i & 4 ? 3 : 1);
  const UprightBox found = upright_box(corners, Eigen::Matrix3d::Identity(), 0.05);
  EXPECT_DOUBLE_EQ(found.yaw_rad, std::numbers::pi / 2) << "the longer edge lies along y";
  EXPECT_TRUE(found.box.size.isApprox(Eigen::Vector3d(3, 1, 2), 1e-9));
  EXPECT_TRUE(found.box.center().isApprox(Eigen::Vector3d(1.5, 2.5, 2), 1e-9));
}

TEST(UprightBox, IsNeverFlatterThanAVoxel) {
  const std::vector<Eigen::Vector3d> one{kCenter};
  const UprightBox found = upright_box(one, Eigen::Matrix3d::Identity(), 0.05);
  EXPECT_TRUE(found.box.size.isApprox(Eigen::Vector3d::Constant(0.05)));
  EXPECT_TRUE(found.box.center().isApprox(kCenter));
}

}  // namespace
}  // namespace rds::mapper
