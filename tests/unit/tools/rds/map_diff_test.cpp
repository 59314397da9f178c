// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/map_diff.hpp"

#include <gmock/gmock.h>

#include "services/mapper/io/map_files.hpp"
#include "services/mapper/core/octree/label_table.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/map/map_export.hpp"

namespace rds::tools {
namespace {

using enum VoxelState;
using octomap::ColorOcTree;
using testing::HasSubstr;

const std::vector<std::string> kLabels{"", "chair", "sofa"};

void set(ColorOcTree& tree, double x, float log_odds, const std::string& label = "") {
  tree.setNodeValue(x, 0.05, 0.05, log_odds);
  const auto color = mapper::label_color(label);
  tree.setNodeColor(static_cast<float>(x), 0.05F, 0.05F, color[0], color[1], color[2]);
  tree.updateInnerOccupancy();
}

class MapDiff : public testing::Test {
 protected:
  MapDiff() {
    for (ColorOcTree* tree : {&a, &b}) {
      set(*tree, 0.05, 0.85F, "chair");
      set(*tree, 0.15, -0.4F);
    }
  }
  MapDifference difference(std::vector<ColoredPoint>* points = nullptr) {
    return compare_maps({a, kLabels}, {b, kLabels}, points);
  }
  /// Exit status of `rds map diff` with the two maps as files.
  int status(const std::vector<std::string>& arguments) {
    EXPECT_TRUE(mapper::write_tree(folder / "a.ot", a));
    EXPECT_TRUE(mapper::write_tree(folder / "b.ot", b));
    CLI::App rds;
    add_map_command(rds);
    std::vector<std::string> all(arguments.rbegin(), arguments.rend());
    all.insert(all.end(), {"diff", "map"});
    try {
      rds.parse(all);
    } catch (const CLI::RuntimeError& e) {
      return e.get_exit_code();
    }
    return 0;
  }
  std::string file(const std::string& name) { return (folder / name).string(); }

  test::TemporaryFolder folder;
  ColorOcTree a{0.1};
  ColorOcTree b{0.1};
};

TEST_F(MapDiff, EqualMapsAreEqual) {
  EXPECT_TRUE(difference().is_equal());
  EXPECT_TRUE(difference().bounds.isEmpty());
  EXPECT_EQ(status({file("a.ot"), file("b.ot")}), 0);
}

TEST_F(MapDiff, CountsEveryPairOfStates) {
  set(a, 0.25, 0.85F);  // occupied, unknown
  set(b, 0.35, 0.85F);  // unknown, occupied
  set(a, 0.45, 0.85F);  // occupied, free
  set(b, 0.45, -0.85F);
  set(b, 0.15, 0.85F);  // free, occupied
  set(a, 0.55, -0.4F);  // free, unknown
  const MapDifference d = difference();
  EXPECT_EQ(d.count(kOccupied, kOccupied), 1U);
  EXPECT_EQ(d.count(kOccupied, kUnknown), 1U);
  EXPECT_EQ(d.count(kUnknown, kOccupied), 1U);
  EXPECT_EQ(d.count(kOccupied, kFree), 1U);
  EXPECT_EQ(d.count(kFree, kOccupied), 1U);
  EXPECT_EQ(d.count(kFree, kUnknown), 1U);
  EXPECT_FALSE(d.has_same_states());
  EXPECT_NEAR(d.bounds.min().x(), 0.1, 1e-6);
  EXPECT_NEAR(d.bounds.max().x(), 0.6, 1e-6);
  EXPECT_THAT(describe(d, false), HasSubstr("occupied in both          1   20.0 %"));
  EXPECT_EQ(status({file("a.ot"), file("b.ot")}), 1);
}

TEST_F(MapDiff, TellsValuesColorsAndLabels) {
  set(b, 0.05, 1.7F, "sofa");
  const MapDifference d = difference();
  EXPECT_TRUE(d.has_same_states());
  EXPECT_FALSE(d.is_equal());
  EXPECT_EQ(d.other_value, 1U);
  EXPECT_EQ(d.other_color, 1U);
  EXPECT_THAT(d.relabelled, testing::ElementsAre(testing::Pair(testing::Pair("chair", "sofa"), 1U)));
  EXPECT_THAT(describe(d, false), HasSubstr("chair -> sofa"));
  EXPECT_THAT(describe(d, true), testing::Not(HasSubstr("label")));
  EXPECT_TRUE(compare_maps({a, {}}, {b, {}}, nullptr).relabelled.empty()) << "no label table, no labels";
  EXPECT_EQ(status({file("a.ot"), file("b.ot"), "--states"}), 0);
}

TEST_F(MapDiff, DrawsWhatDiffers) {
  set(a, 0.25, 0.85F);
  set(b, 0.35, 0.85F);
  std::vector<ColoredPoint> points;
  difference(&points);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_NEAR(points[1].center.x(), 0.25, 1e-5);
  EXPECT_GT(points[1].rgb[0], points[1].rgb[1]) << "only in A: red";
  EXPECT_GT(points[2].rgb[1], points[2].rgb[0]) << "only in B: green";
  EXPECT_EQ(status({file("a.ot"), file("b.ot"), "--out", file("diff.ply")}), 1);
  const std::string ply = test::read_text(folder / "diff.ply");
  EXPECT_EQ(ply.size() - ply.find("end_header\n") - 11, 3U * 15);
}

TEST_F(MapDiff, ReadsEveryKindOfMap) {
  set(b, 0.05, 1.7F, "sofa");  // not told by .bt
  ASSERT_TRUE(export_map(b, "bt", folder / "b.bt", "-y"));
  EXPECT_EQ(status({file("a.ot"), file("b.bt")}), 0);
  std::filesystem::create_directories(folder / "run");
  ASSERT_TRUE(mapper::write_tree(folder / "run" / "map.ot", a));
  EXPECT_EQ(status({file("a.ot"), file("run")}), 0);
}

TEST_F(MapDiff, RefusesWhatCannotBeCompared) {
  ASSERT_TRUE(mapper::write_tree(folder / "coarse.ot", ColorOcTree(0.2)));
  EXPECT_EQ(status({file("a.ot"), file("coarse.ot")}), 2);
  EXPECT_EQ(status({file("a.ot"), file("nowhere.ot")}), 2);
  test::write_text(folder / "torn.bt", "# Octomap OcTree binary file\nid OcTree\nres 0.1\ndata\nx");
  EXPECT_EQ(status({file("torn.bt"), file("b.ot")}), 2);
}

}  // namespace
}  // namespace rds::tools
