// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/object_extent.hpp"

#include <gtest/gtest.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

using test::point_at;
using test::SyntheticKeyframe;

const cv::Rect kTable(80, 80, 160, 80);
constexpr double kTableM = 2.0;

TEST(ObjectExtent, WhatMostViewsTookForSomethingElseIsNotTheObjects) {
  SemanticMapper mapper(MapperConfig{});
  const cv::Rect shelf(240, 80, 40, 80);
  for (std::uint64_t id = 0; id < 8; ++id) {
    SyntheticKeyframe keyframe(id);
    keyframe.rectangle(kTable, kTableM).rectangle(shelf, kTableM + 0.05);
    mapper.integrate(keyframe.box("diningtable", id == 3 ? kTable | shelf : kTable, false));
  }
  const auto objects = mapper.map().objects();
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_NEAR(objects[0].center.x(), point_at(160, 120, kTableM).x(), 0.03);
  EXPECT_NEAR(objects[0].size.x(), 160 * kTableM / 290, 0.08);
}

TEST(ObjectExtent, ASideThatFewViewsShowedCountsAsMuch) {
  SemanticMapper mapper(MapperConfig{});
  const cv::Rect left(80, 80, 90, 80);
  for (std::uint64_t id = 0; id < 12; ++id) {
    SyntheticKeyframe keyframe(id);
    keyframe.rectangle(kTable, kTableM);
    if (id > 1) keyframe.rectangle({170, 0, 150, 240}, 1.0);  // somebody stands before the right half
    mapper.integrate(keyframe.box("diningtable", id > 1 ? left : kTable, false));
  }
  const auto objects = mapper.map().objects();
  ASSERT_EQ(objects.size(), 1U);
  EXPECT_NEAR(objects[0].center.x(), point_at(160, 120, kTableM).x(), 0.03);
}

TEST(ObjectExtent, TheUprightBoxIsTurnedAsTheObjectStands) {
  SemanticMapper mapper(MapperConfig{});
  const geometry::Pose turned(
      Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));  // 29° about the direction up
  for (std::uint64_t id = 0; id < 4; ++id)
    mapper.integrate(
        SyntheticKeyframe(id).rectangle(kTable, kTableM).box("diningtable", kTable, false).pose(turned));
  const Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  const auto objects = mapper.map().objects(up);
  ASSERT_EQ(objects.size(), 1U);
  const geometry::OrientedBox& box = objects[0].upright.box;
  EXPECT_TRUE(box.map_from_box.linear().col(2).isApprox(up, 1e-9));
  const Eigen::Vector3d along_table = turned.linear().col(0);
  EXPECT_GT(std::abs(box.map_from_box.linear().col(0).dot(along_table)), std::cos(0.05));
  EXPECT_NEAR(box.size.x(), 160 * kTableM / 290, 0.08);
  EXPECT_LT(box.size.y(), 0.11) << "a front of which nobody saw more is thin";
  EXPECT_GT(objects[0].size.z(), 0.4) << "along the axes it is not";
  EXPECT_LT((box.center() - turned * point_at(160, 120, kTableM)).norm(), 0.05);
}

TEST(ObjectExtent, AVoxelIsOfTheNearestObject) {
  SemanticMapper mapper(MapperConfig{});
  const cv::Rect left(60, 80, 80, 80);
  const cv::Rect right(150, 80, 80, 80);
  for (std::uint64_t id = 0; id < 3; ++id)
    mapper.integrate(SyntheticKeyframe(id)
                         .rectangle(left, kTableM)
                         .rectangle(right, kTableM)
                         .box("chair", left, false)
                         .box("chair", right, false));
  const auto objects = mapper.map().objects();
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_NEAR(objects[0].center.x(), point_at(100, 120, kTableM).x(), 0.04);
  EXPECT_NEAR(objects[1].center.x(), point_at(190, 120, kTableM).x(), 0.04);
}

}  // namespace
}  // namespace rds::mapper
