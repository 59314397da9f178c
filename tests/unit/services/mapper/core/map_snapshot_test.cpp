// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/map_snapshot.hpp"

#include <bit>
#include <cstring>

#include <gmock/gmock.h>

#include "services/mapper/core/octree/tree_bytes.hpp"
#include "tests/unit/services/mapper/core/random_keyframes.hpp"

namespace rds::mapper {
namespace {

using test::SyntheticKeyframe;

const cv::Rect kChair(100, 60, 90, 120);

SemanticMapper mapper_with(const std::string& label, bool color_by_label) {
  MapperConfig config;
  config.octree.color_by_label = color_by_label;
  SemanticMapper mapper(config);
  mapper.integrate(SyntheticKeyframe(0).rectangle(kChair, 1.5).box(label, kChair, false));
  return mapper;
}

template <class Value>
Value at(const std::vector<std::uint8_t>& bytes, std::size_t offset) {
  Value value;
  std::memcpy(&value, &bytes[offset], sizeof(Value));
  return value;
}

TEST(MapSnapshot, PointsAreTheOccupiedVoxelsWithColorAndLabel) {
  const SemanticMapper mapper = mapper_with("chair", true);
  const MapSnapshot snapshot = take_snapshot(mapper);
  const MapPoints points = points_of(mapper.map().tree(), snapshot);
  ASSERT_EQ(points.count, extent_of(mapper.map().content->octree).occupied);
  ASSERT_EQ(points.rows.size(), points.count * std::size_t{20});
  std::size_t chairs = 0;
  for (std::size_t row = 0; row < points.rows.size(); row += 20) {
    const auto* voxel = mapper.map().tree().search(
        at<float>(points.rows, row), at<float>(points.rows, row + 4), at<float>(points.rows, row + 8));
    ASSERT_NE(voxel, nullptr);
    EXPECT_GT(voxel->getLogOdds(), 0);
    const auto color = voxel->getColor();
    EXPECT_EQ(at<std::uint32_t>(points.rows, row + 12),
              static_cast<std::uint32_t>(color.r << 16 | color.g << 8 | color.b));
    chairs += at<std::uint32_t>(points.rows, row + 16) == 1 ? 1U : 0U;
  }
  EXPECT_GT(chairs, 100U);
  EXPECT_LT(chairs, points.count);
}

TEST(MapSnapshot, TheExtentIsOctoMapsOwn) {
  const SemanticMapper mapper = mapper_with("chair", true);
  const MapExtent extent = extent_of(mapper.map().content->octree);
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  mapper.map().tree().getMetricMin(low.x(), low.y(), low.z());
  mapper.map().tree().getMetricMax(high.x(), high.y(), high.z());
  EXPECT_TRUE(extent.min.isApprox(low)) << extent.min.transpose();
  EXPECT_TRUE(extent.max.isApprox(high)) << extent.max.transpose();
  EXPECT_EQ(extent_of(SemanticOctree({})).occupied, 0U);
}

TEST(MapSnapshot, LabelsThatColorsDoNotTellAreListed) {
  const SemanticMapper by_label = mapper_with("chair", true);
  EXPECT_TRUE(labels_not_shown_by_colors(by_label.map().tree(), take_snapshot(by_label)).keys.empty());
  const SemanticMapper by_picture = mapper_with("chair", false);
  const LabelRows rows = labels_not_shown_by_colors(by_picture.map().tree(), take_snapshot(by_picture));
  ASSERT_GT(rows.values.size(), 100U);
  EXPECT_EQ(rows.keys.size(), 3 * rows.values.size());
  EXPECT_THAT(rows.values, testing::Each(1));
  for (std::size_t i = 0; i < rows.values.size(); ++i)
    EXPECT_EQ(by_picture.map().label({rows.keys[3 * i], rows.keys[3 * i + 1], rows.keys[3 * i + 2]}), 1);
}

TEST(MapSnapshot, ASurfaceInALabelsColorIsNotTakenForIt) {
  SemanticMapper mapper(MapperConfig{});
  const Rgb chair = label_color("chair");
  mapper.integrate(SyntheticKeyframe(0)
                       .rectangle(kChair, 1.5, cv::Scalar(chair[2], chair[1], chair[0]))
                       .rectangle({10, 10, 40, 40}, 1.0)
                       .box("chair", {10, 10, 40, 40}, false));
  const test::PublishedMap published(mapper, 1);
  EXPECT_FALSE(published.untold.keys.empty());
  OctreeReplica replica;
  ASSERT_EQ(replica.apply(published.full).status, ReplicaStatus::kApplied);
  test::expect_same(replica, mapper);
}

}  // namespace
}  // namespace rds::mapper
