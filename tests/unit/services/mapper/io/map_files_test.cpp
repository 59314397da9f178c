// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/io/map_files.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "services/mapper/core/octree/tree_bytes.hpp"
#include "services/mapper/io/octomap_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/mapper/core/synthetic_keyframe.hpp"

namespace rds::mapper {
namespace {

class MapFiles : public testing::Test {
 protected:
  MapFiles() { mapper_.integrate(test::SyntheticKeyframe(0).make()); }

  std::string refusal(const std::string& content) {
    std::ofstream(folder_.path() / "bad.ot", std::ios::binary) << content;
    const auto read = read_tree(folder_.path() / "bad.ot");
    EXPECT_FALSE(read.has_value());
    return read ? "" : read.error();
  }

  rds::test::TemporaryFolder folder_;
  SemanticMapper mapper_{MapperConfig{}};
};

TEST_F(MapFiles, ATreeReadsBackAndOctoMapReadsItToo) {
  ASSERT_TRUE(write_tree(folder_.path() / "map.ot", mapper_.map().tree()));
  auto read = read_tree(folder_.path() / "map.ot");
  ASSERT_TRUE(read.has_value()) << read.error();
  EXPECT_TRUE(looks_like_tree(folder_.path() / "map.ot"));
  EXPECT_FALSE(looks_like_tree(folder_.path()));
  EXPECT_EQ((*read)->getResolution(), 0.05);
  EXPECT_EQ(to_bytes(**read), to_bytes(mapper_.map().tree()));
  const std::unique_ptr<octomap::AbstractOcTree> octomaps(
      octomap::AbstractOcTree::read((folder_.path() / "map.ot").string()));
  ASSERT_NE(octomaps, nullptr);
  EXPECT_EQ(octomaps->getTreeType(), "ColorOcTree");
  EXPECT_EQ(octomaps->size(), mapper_.map().tree().size());
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "map.ot.partial"));
}

TEST_F(MapFiles, ASavedMapGoesOn) {
  ASSERT_TRUE(write_tree(folder_.path() / "map.ot", mapper_.map().tree()));
  auto read = read_tree(folder_.path() / "map.ot");
  ASSERT_TRUE(read.has_value());
  SemanticMapper continued{MapperConfig{}};
  ASSERT_TRUE(test::start_from(continued, std::move(**read)));
  EXPECT_EQ(to_bytes(continued.map().tree()), to_bytes(mapper_.map().tree()));
  continued.integrate(test::SyntheticKeyframe(1).make());
  mapper_.integrate(test::SyntheticKeyframe(1).make());
  EXPECT_EQ(continued.map().tree().size(), mapper_.map().tree().size());
  continued.settle({});
  EXPECT_FLOAT_EQ(test::log_odds_at(continued.map().tree(), test::point_at(20, 20, 3.0)), 1.7F);
  EXPECT_FALSE(test::start_from(continued, octomap::ColorOcTree(0.1)));
}

TEST_F(MapFiles, RefusesTornAndForeignFilesWithASentence) {
  ASSERT_TRUE(write_tree(folder_.path() / "map.ot", mapper_.map().tree()));
  std::ifstream in(folder_.path() / "map.ot", std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(in), {}};
  EXPECT_THAT(refusal(good.substr(0, good.size() / 2)),
              testing::HasSubstr("bad.ot: is damaged: the tree ends after"));
  EXPECT_THAT(refusal(good + "x"), testing::HasSubstr("1 bytes after the last node"));
  EXPECT_THAT(refusal("P5 picture"), testing::HasSubstr("is not an OctoMap .ot or .bt file"));
  EXPECT_THAT(refusal(""), testing::HasSubstr("is not an OctoMap .ot or .bt file"));
  EXPECT_THAT(refusal("# Octomap OcTree file\nid OcTree\nsize 0\nres 0.05\ndata\n"),
              testing::HasSubstr("'OcTree'"));
  EXPECT_THAT(refusal("# Octomap OcTree file\nid ColorOcTree\nres x\ndata\n"),
              testing::HasSubstr("resolution"));
  EXPECT_THAT(read_tree(folder_.path() / "none.ot").error(), testing::HasSubstr("none.ot: cannot be read"));
  EXPECT_THAT(read_tree(folder_.path()).error(), testing::HasSubstr("cannot be read"));
}

TEST_F(MapFiles, WritesTheOtherFilesOfARun) {
  const auto grid = make_grid(mapper_.map().tree(), mapper_.up_in_map(), {});
  const auto files = files_for_others(mapper_.map().tree(), mapper_.map().objects(), grid);
  const auto content = [&](const std::string& name) {
    const auto& bytes = files.at(name);
    return std::string(bytes.begin(), bytes.end());
  };
  EXPECT_EQ(content("objects.json"), "[]\n");
  EXPECT_THAT(content("grid.pgm"), testing::StartsWith("P5\n"));
  EXPECT_THAT(content("grid.yaml"), testing::HasSubstr("image: grid.pgm"));
  EXPECT_TRUE(starts_as_octomap_file(content("map.ot")));
  EXPECT_THAT(write_tree(folder_.path() / "no" / "map.ot", mapper_.map().tree()).error(),
              testing::HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace rds::mapper
