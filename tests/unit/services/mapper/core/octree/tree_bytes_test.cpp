// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/octree/tree_bytes.hpp"

#include <sstream>

#include <gmock/gmock.h>
#include <octomap/OcTree.h>

#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

std::vector<std::uint8_t> some_tree() {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(test::SyntheticKeyframe(0).make());
  return to_bytes(mapper.map().tree());
}

TEST(TreeBytes, AreWhatOctoMapWritesAndReads) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(test::SyntheticKeyframe(0).make());
  std::stringstream octomaps;
  mapper.map().tree().writeData(octomaps);
  const auto ours = to_bytes(mapper.map().tree());
  EXPECT_EQ(octomaps.str(), std::string(ours.begin(), ours.end()));
  octomap::ColorOcTree read(0.05);
  read.readData(octomaps);
  EXPECT_EQ(to_bytes(read), ours);
  const auto back = tree_from_bytes(ours, 0.05);
  ASSERT_TRUE(back.has_value()) << back.error();
  EXPECT_EQ(to_bytes(**back), ours);
}

TEST(TreeBytes, ExpandPrunedLeaves) {
  octomap::ColorOcTree pruned(0.1);
  for (float x = 0.05F; x < 0.4F; x += 0.1F)
    for (float y = 0.05F; y < 0.4F; y += 0.1F)
      for (float z = 0.05F; z < 0.4F; z += 0.1F) pruned.updateNode(x, y, z, true);
  pruned.updateInnerOccupancy();
  pruned.prune();
  ASSERT_LT(pruned.getNumLeafNodes(), 64U);
  const auto read = tree_from_bytes(to_bytes(pruned), 0.1);
  ASSERT_TRUE(read.has_value()) << read.error();
  EXPECT_EQ((*read)->getNumLeafNodes(), 64U);
}

TEST(TreeBytes, RefuseEveryTruncation) {
  const auto whole = some_tree();
  for (std::size_t length = 1; length < whole.size(); length += whole.size() / 20)
    EXPECT_FALSE(tree_from_bytes({whole.data(), length}, 0.05).has_value()) << length;
}

TEST(TreeBytes, RefuseHostileBytes) {
  auto bytes = some_tree();
  bytes.push_back(0);
  EXPECT_THAT(tree_from_bytes(bytes, 0.05).error(), testing::HasSubstr("after the last node"));
  EXPECT_FALSE(tree_from_bytes(some_tree(), 0.0).has_value());
  EXPECT_FALSE(tree_from_bytes(some_tree(), NAN).has_value());
  const std::vector<std::uint8_t> children_without_end(8000, 0xff);  // NaN as well
  EXPECT_FALSE(tree_from_bytes(children_without_end, 0.05).has_value());
  std::vector<std::uint8_t> deep;
  for (int i = 0; i < 40; ++i) deep.insert(deep.end(), {0, 0, 0, 0, 1, 2, 3, 1});
  EXPECT_THAT(tree_from_bytes(deep, 0.05).error(), testing::HasSubstr("below the finest level"));
  const std::vector<std::uint8_t> one_huge_leaf{0, 0, 0, 0, 1, 2, 3, 0};
  EXPECT_THAT(tree_from_bytes(one_huge_leaf, 0.05).error(), testing::HasSubstr("larger than any map"));
}

TEST(BinaryTreeBytes, AreWhatOctoMapWritesOfThePrunedTree) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(test::SyntheticKeyframe(0).make());
  const auto ours = to_binary_bytes(mapper.map().tree());
  octomap::OcTree read(0.05);  // as octomap_msgs::binaryMsgToMap makes it
  std::stringstream stream(std::string(ours.begin(), ours.end()));
  read.readBinaryData(stream);
  EXPECT_EQ(stream.peek(), EOF);
  octomap::ColorOcTree pruned(0.05);
  std::stringstream full;
  mapper.map().tree().writeData(full);
  pruned.readData(full);
  pruned.toMaxLikelihood();
  pruned.prune();
  std::ostringstream octomaps;
  pruned.writeBinaryData(octomaps);
  EXPECT_EQ(octomaps.str(), std::string(ours.begin(), ours.end()));
  EXPECT_LT(ours.size(), to_bytes(mapper.map().tree()).size() / 10);
}

TEST(BinaryTreeBytes, ComeBackVoxelByVoxel) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(test::SyntheticKeyframe(0).make());
  const auto read = tree_from_binary_bytes(to_binary_bytes(mapper.map().tree()), 0.05);
  ASSERT_TRUE(read) << read.error();
  ASSERT_EQ((*read)->getNumLeafNodes(), mapper.map().tree().getNumLeafNodes());
  for (auto leaf = (*read)->begin_leafs(), end = (*read)->end_leafs(); leaf != end; ++leaf)
    ASSERT_EQ((*read)->isNodeOccupied(*leaf),
              mapper.map().tree().isNodeOccupied(mapper.map().tree().search(leaf.getKey())));
  EXPECT_EQ(to_binary_bytes(**read), to_binary_bytes(mapper.map().tree()));
  EXPECT_TRUE(to_binary_bytes(octomap::ColorOcTree(0.1)).empty());
}

TEST(BinaryTreeBytes, RefuseTruncationsAndHostileBytes) {
  SemanticMapper mapper(MapperConfig{});
  mapper.integrate(test::SyntheticKeyframe(0).make());
  const auto whole = to_binary_bytes(mapper.map().tree());
  for (std::size_t length = 1; length < whole.size(); length += whole.size() / 20)
    EXPECT_FALSE(tree_from_binary_bytes({whole.data(), length}, 0.05)) << length;
  const std::vector<std::uint8_t> ever_deeper(400, 0xff);
  EXPECT_THAT(tree_from_binary_bytes(ever_deeper, 0.05).error(),
              testing::HasSubstr("below the finest level"));
  const std::vector<std::uint8_t> an_eighth_of_everything{1, 0};
  EXPECT_THAT(tree_from_binary_bytes(an_eighth_of_everything, 0.05).error(),
              testing::HasSubstr("larger than any map"));
}

}  // namespace
}  // namespace rds::mapper
