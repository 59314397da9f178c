// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/voxels/voxel_set.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace rds::evaluation {
namespace {

TEST(VoxelSet, PacksNegativeIndices) {
  for (const Eigen::Vector3i& index :
       {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(-1, 5, -70000), Eigen::Vector3i(9, -9, 1)})
    EXPECT_EQ(unpack(pack(index)), index);
  EXPECT_EQ(unpack(voxel_of({-0.01, 0.0, 0.149}, 0.05)), Eigen::Vector3i(-1, 0, 2));
}

TEST(VoxelSet, FindsNeighboursInTheCubeOnly) {
  const VoxelSet set = make_voxel_set({pack({3, -2, 7}), pack({3, -2, 7})});
  ASSERT_EQ(set.size(), 1U);
  EXPECT_TRUE(has_neighbour(set, pack({3, -2, 7}), 0));
  EXPECT_TRUE(has_neighbour(set, pack({2, -3, 8}), 1));
  EXPECT_FALSE(has_neighbour(set, pack({1, -2, 7}), 1));
  EXPECT_FALSE(has_neighbour(set, pack({3, -2, 9}), 1));
  EXPECT_TRUE(has_neighbour(set, pack({5, 0, 5}), 2));
  EXPECT_FALSE(has_neighbour({}, pack({0, 0, 0}), 2));
}

TEST(VoxelSet, CountsSets) {
  const auto counted = count_voxels({{1, 2}, {2, 5}, {2}});
  ASSERT_EQ(counted.size(), 3U);
  EXPECT_EQ(counted[1].key, 2);
  EXPECT_EQ(counted[1].count, 3U);
}

TEST(VoxelSet, KeepsFarPointsInRange) {
  const auto key = voxel_of({1e30, -1e30, 0}, 0.05);
  EXPECT_GT(unpack(key).x(), 1000000);
  EXPECT_LT(unpack(key).y(), -1000000);
}

}  // namespace
}  // namespace rds::evaluation
