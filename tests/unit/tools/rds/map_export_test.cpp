// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/map_export.hpp"

#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/io/map_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::tools {
namespace {
using testing::HasSubstr;

class MapExportTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto chair = mapper::label_color("chair");
    for (int i = 0; i < 3; ++i) tree.setNodeValue(1.05 + 0.1 * i, 0.05, 2.05, 0.85F);
    tree.setNodeColor(1.05F, 0.05F, 2.05F, chair[0], chair[1], chair[2]);
    tree.setNodeValue(-1.05, 0.05, 0.05, -0.4F);
    tree.updateInnerOccupancy();
  }
  std::string exported(const std::string& format) {
    const auto file = folder / ("map." + format);
    const auto written = export_map(tree, format, file, "-y");
    return written ? test::read_text(file) : written.error();
  }
  test::TemporaryFolder folder;
  octomap::ColorOcTree tree{0.1};
};

TEST_F(MapExportTest, DescribesWhatIsThere) {
  const auto json = describe_map(tree);
  EXPECT_EQ(json.at("occupied_voxels"), 3);
  EXPECT_EQ(json.at("free_voxels"), 1);
  EXPECT_EQ(json.at("leaves"), 4);
  std::uint64_t key_sum = 0;  // of all voxels, whichever leaves stand for them
  octomap::ColorOcTree whole(tree);
  whole.expand();
  for (auto leaf = whole.begin_leafs(); leaf != whole.end_leafs(); ++leaf)
    if (leaf->getLogOdds() > 0) key_sum += leaf.getKey()[0] + leaf.getKey()[1] + leaf.getKey()[2];
  EXPECT_EQ(json.at("occupied_key_sum"), key_sum);
  EXPECT_NEAR(json.at("bounds_min")[0], 1.0, 1e-6);
  EXPECT_NEAR(json.at("bounds_max")[0], 1.3, 1e-6);
  EXPECT_NEAR(json.at("occupied_m3"), 0.003, 1e-9);
  EXPECT_FALSE(describe_map(octomap::ColorOcTree(0.1)).contains("bounds_min"));
}

TEST_F(MapExportTest, AnswersForOccupiedFreeAndUnknown) {
  const std::vector<std::string> labels{"", "person", "chair"};
  const auto chair = query_map(tree, {1.05, 0.05, 2.05}, labels);
  EXPECT_EQ(chair.at("state"), "occupied");
  EXPECT_EQ(chair.at("label"), "chair");
  EXPECT_NEAR(chair.at("probability"), 0.70, 0.01);
  const auto free = query_map(tree, {-1.05, 0.05, 0.05}, labels);
  EXPECT_EQ(free.at("state"), "free");
  EXPECT_FALSE(free.contains("label"));
  EXPECT_EQ(query_map(tree, {9, 9, 9}, labels).at("state"), "unknown");
  EXPECT_EQ(query_map(tree, {1e300, 9, 9}, labels).at("state"), "unknown");
}

TEST_F(MapExportTest, OtAndBtAreReadBack) {
  exported("ot");
  const auto read = mapper::read_tree(folder / "map.ot");
  ASSERT_TRUE(read) << read.error();
  EXPECT_TRUE(**read == tree);
  exported("bt");
  octomap::OcTree binary(0.1);
  ASSERT_TRUE(binary.readBinary((folder / "map.bt").string()));
  EXPECT_TRUE(binary.isNodeOccupied(binary.search(1.05, 0.05, 2.05)));
  EXPECT_FALSE(binary.isNodeOccupied(binary.search(-1.05, 0.05, 0.05)));
}

TEST_F(MapExportTest, PlyAndPcdHoldTheOccupiedVoxels) {
  const std::string ply = exported("ply");
  EXPECT_THAT(ply, HasSubstr("element vertex 3\n"));
  EXPECT_EQ(ply.size() - ply.find("end_header\n") - 11, 3U * 15);
  const std::string pcd = exported("pcd");
  EXPECT_THAT(pcd, HasSubstr("POINTS 3\n"));
  const std::size_t data = pcd.find("DATA binary\n") + 12;
  ASSERT_EQ(pcd.size() - data, 3U * 16);
  float x = 0;
  std::memcpy(&x, pcd.data() + data, sizeof(x));
  EXPECT_NEAR(x, 1.05, 1e-5);
}

TEST_F(MapExportTest, PgmComesWithItsYaml) {
  EXPECT_THAT(exported("pgm"), testing::StartsWith("P5"));
  EXPECT_THAT(test::read_text(folder / "map.yaml"), HasSubstr("image: map.pgm"));
}

TEST_F(MapExportTest, NamesWhatCannotBeDone) {
  EXPECT_THAT(exported("xyz"), HasSubstr("expected one of ot, bt, ply, pcd, pgm"));
  for (const char* format : kMapFormats)
    EXPECT_THAT(export_map(tree, format, "/nowhere/map", "z").error(), HasSubstr("/nowhere/map")) << format;
  EXPECT_EQ(format_of("a/b.ply"), "ply");
  EXPECT_EQ(format_of("a/b.png"), "");
}

}  // namespace
}  // namespace rds::tools
