// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/transforms/transform_tree.hpp"

#include <gtest/gtest.h>

namespace rds::geometry {
namespace {

constexpr std::int64_t kS = 1'000'000'000;
using Frames = std::vector<std::string>;

Pose at(double x, double y, double z, double turn_rad = 0) {
  return make_pose({x, y, z}, Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ())));
}

TEST(TransformTree, JoinsFramesByTheirCommonParent) {
  TransformTree tree;
  tree.set_static("base", "camera", at(1, 0, 0, M_PI / 2));
  tree.set_static("camera", "optical", at(0, 2, 0));
  tree.set_static("base", "laser", at(0, 0, 3));
  EXPECT_EQ(tree.root_of("optical", 0), "base");
  EXPECT_EQ(tree.ancestry("optical", 0), (Frames{"optical", "camera", "base"}));
  EXPECT_EQ(tree.ancestry("base", 0), Frames{"base"});
  const auto laser_from_optical = tree.lookup("laser", "optical", 5 * kS);
  ASSERT_TRUE(laser_from_optical);
  EXPECT_TRUE(
      laser_from_optical->isApprox(at(0, 0, 3).inverse() * at(1, 0, 0, M_PI / 2) * at(0, 2, 0), 1e-12));
  EXPECT_FALSE(tree.lookup("base", "elsewhere", 0));
  EXPECT_TRUE(tree.lookup("alone", "alone", 0)->isApprox(Pose::Identity()));
}

TEST(TransformTree, InterpolatesInTime) {
  TransformTree tree;
  tree.set("odom", "base", 1 * kS, at(0, 0, 0));
  tree.set("odom", "base", 2 * kS, at(2, 0, 0, 0.4));
  EXPECT_TRUE(tree.lookup("odom", "base", 3 * kS / 2)->isApprox(at(1, 0, 0, 0.2), 1e-12));
  EXPECT_TRUE(tree.lookup("odom", "base", 3 * kS)->isApprox(at(2, 0, 0, 0.4), 1e-12)) << "as it was last";
  EXPECT_TRUE(tree.lookup("odom", "base", 0)->isApprox(at(0, 0, 0), 1e-12));
}

/// A picture may be tracked before the transform of its time has come.
TEST(TransformTree, GoesOnForOneIntervalWhereTransformsComeSteadily) {
  TransformTree tree;
  tree.set("mast", "camera", 1 * kS, at(0, 0, 0, 0.1));
  tree.set("mast", "camera", 1 * kS + 20 * kS / 1000, at(0, 0, 0, 0.12));
  EXPECT_TRUE(tree.lookup("mast", "camera", 1 * kS + 30 * kS / 1000)->isApprox(at(0, 0, 0, 0.13), 1e-12));
  EXPECT_TRUE(tree.lookup("mast", "camera", 2 * kS)->isApprox(at(0, 0, 0, 0.14), 1e-12)) << "not for ever";
}

TEST(TransformTree, ForgetsWhatIsNotRepeatedUnlessItIsStatic) {
  TransformTree tree;
  tree.set("odom", "base", 1 * kS, at(1, 0, 0));
  tree.set_static("base", "camera", at(0, 0, 1));
  EXPECT_EQ(tree.root_of("camera", 5 * kS), "odom");
  EXPECT_EQ(tree.root_of("camera", 7 * kS), "base");
}

TEST(TransformTree, TakesTheNewestParentAndStampsThatGoBack) {
  TransformTree tree;
  tree.set("a", "frame", 9 * kS, at(1, 0, 0));
  tree.set("b", "frame", 9 * kS, at(2, 0, 0));
  EXPECT_EQ(tree.ancestry("frame", 9 * kS), (Frames{"frame", "b"}));
  tree.set("b", "frame", 3 * kS, at(3, 0, 0));
  EXPECT_TRUE(tree.lookup("b", "frame", 3 * kS)->isApprox(at(3, 0, 0), 1e-12));
}

TEST(TransformTree, EndsInACircleAndKeepsItsBound) {
  TransformTree tree;
  tree.set_static("a", "b", at(0, 0, 0));
  tree.set_static("b", "a", at(0, 0, 0));
  EXPECT_FALSE(tree.root_of("a", 0).empty());
  EXPECT_TRUE(tree.lookup("a", "a", 0));
  tree.set_static("self", "self", at(0, 0, 0));
  EXPECT_EQ(tree.ancestry("self", 0), Frames{"self"});
  for (std::size_t i = 0; i < 2 * TransformTree::kMaxFrames; ++i)
    tree.set_static("x", "f" + std::to_string(i), at(0, 0, 0));
  const std::string last = "f" + std::to_string(2 * TransformTree::kMaxFrames - 1);
  EXPECT_EQ(tree.ancestry(last, 0), Frames{last});
}

}  // namespace
}  // namespace rds::geometry
