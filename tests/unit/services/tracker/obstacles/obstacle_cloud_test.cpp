// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/obstacles/obstacle_cloud.hpp"

#include <cstring>

#include <gmock/gmock.h>

namespace rds::tracker {
namespace {

ImageObject person(const Eigen::Vector3d& center, const Eigen::Vector3d& size) {
  ImageObject object;
  object.object.box.map_from_box.translation() = center;
  object.object.box.size = size;
  return object;
}

std::vector<Eigen::Vector3f> points_of(const sensor_msgs::msg::PointCloud2& cloud) {
  std::vector<Eigen::Vector3f> points(cloud.width());
  for (std::size_t i = 0; i < points.size(); ++i)
    std::memcpy(points[i].data(), cloud.data().data() + i * cloud.point_step(), 12);
  return points;
}

TEST(ObstacleCloud, FillsTheBoxOfEachObject) {
  const std::vector<ImageObject> objects{person({2, 1, 0}, {0.5, 0.5, 1.7}),
                                         person({4, 0, 0}, {0.3, 0.3, 0.3})};
  const auto cloud = obstacle_cloud(objects, {});
  const auto points = points_of(cloud);
  ASSERT_EQ(points.size(), 6U * 6 * 18 + 4 * 4 * 4);
  EXPECT_EQ(cloud.data().size(), points.size() * cloud.point_step());
  Eigen::AlignedBox3f first;
  for (std::size_t i = 0; i < 6 * 6 * 18; ++i) first.extend(points[i]);
  EXPECT_TRUE(first.min().isApprox(Eigen::Vector3f(1.75F, 0.75F, -0.85F), 1e-5F));
  EXPECT_TRUE(first.max().isApprox(Eigen::Vector3f(2.25F, 1.25F, 0.85F), 1e-5F));
  EXPECT_NEAR(points.back().x(), 4.15F, 1e-5F);
}

TEST(ObstacleCloud, IsBoundedForABoxOfAnySize) {
  const std::vector<ImageObject> objects{person({0, 0, 0}, {1e6, 1e-6, 1e6})};
  EXPECT_EQ(obstacle_cloud(objects, {}).width(), 51U * 2 * 51);
}

TEST(ObstacleCloud, IsEmptyWhereNobodyIs) {
  const auto cloud = obstacle_cloud({}, {});
  EXPECT_EQ(cloud.width(), 0U);
  EXPECT_EQ(cloud.fields().size(), 3U) << "a costmap reads it, too: nobody is there any more";
}

}  // namespace
}  // namespace rds::tracker
