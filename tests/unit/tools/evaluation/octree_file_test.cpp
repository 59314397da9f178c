// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/octree_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::evaluation {
namespace {
using testing::HasSubstr;

class OctreeFileTest : public testing::Test {
 protected:
  /// A pruned block of 4×4×4 voxels, two single voxels, and a free one.
  void SetUp() override {
    for (int x = 0; x < 4; ++x)
      for (int y = 0; y < 4; ++y)
        for (int z = 0; z < 4; ++z) tree.setNodeValue(0.05 + 0.1 * x, 0.05 + 0.1 * y, 0.05 + 0.1 * z, 2.0F);
    tree.setNodeValue(-1.05, 2.05, 0.35, 0.5F);
    tree.setNodeValue(5.05, 5.05, 5.05, 1.5F);
    tree.setNodeValue(-3.05, 0.05, 0.05, -1.0F);
    tree.prune();
    ASSERT_TRUE(tree.write(file.string()));
  }
  test::TemporaryFolder folder;
  std::filesystem::path file = folder / "map.ot";
  octomap::ColorOcTree tree{0.1};
};

TEST_F(OctreeFileTest, AgreesWithOctomap) {
  const auto read = read_octree_file(file);
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->type, "ColorOcTree");
  EXPECT_EQ(read->nodes, tree.size());
  EXPECT_EQ(read->leaves.size(), tree.getNumLeafNodes());
  const auto centers = read->occupied_centers();
  EXPECT_EQ(centers.size(), 66U);
  for (const auto& c : centers) {
    const auto* node = tree.search(c.x(), c.y(), c.z());
    ASSERT_NE(node, nullptr);
    EXPECT_GT(node->getLogOdds(), 0);
  }
}

TEST_F(OctreeFileTest, EveryTornFileIsAnError) {
  const std::string bytes = test::read_text(file);
  for (std::size_t size = 0; size < bytes.size(); size += 13) {
    test::write_text(file, bytes.substr(0, size));
    const auto read = read_octree_file(file);
    // What ends right behind the header is an empty tree.
    EXPECT_TRUE(!read || read->leaves.empty()) << size;
  }
  test::write_text(file, bytes + "x");
  EXPECT_THAT(read_octree_file(file).error(), HasSubstr("torn"));
}

TEST_F(OctreeFileTest, SurvivesEveryChangedByte) {
  const std::string good = test::read_text(file);
  for (std::size_t i = 0; i < good.size(); i += 7) {
    std::string bytes = good;
    bytes[i] = static_cast<char>(0xFF);
    test::write_text(file, bytes);
    const auto read = read_octree_file(file);
    EXPECT_TRUE(read || read.error().find("map.ot") != std::string::npos);
  }
}

TEST_F(OctreeFileTest, NamesWhatIsNoTree) {
  EXPECT_THAT(read_octree_file(folder / "none.ot").error(), HasSubstr("none.ot: cannot be read"));
  test::write_text(file, "hello");
  EXPECT_THAT(read_octree_file(file).error(), HasSubstr("expected"));
}

}  // namespace
}  // namespace rds::evaluation
