// SPDX-License-Identifier: Apache-2.0
// Two runs on parts of a rendered floor that have a room in common, and the map that `rds map merge` makes of
// what they saved.
#include <algorithm>

#include <gmock/gmock.h>

#include "common/geometry/trajectory.hpp"
#include "common/map_file/saved_map.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/evaluation/map_score.hpp"
#include "tools/evaluation/trajectory_evaluation.hpp"

namespace rds::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Of the recording: the earlier part goes from a corridor into a room, the later one from that room into
// another.
constexpr int kEarlierFrames = 190;
constexpr int kLaterStart = 130;
constexpr int kLaterFrames = 170;
constexpr int kOtherRoom = 296;  // a frame that shows what the earlier part has not seen

ProcessResult merge(const fs::path& a, const fs::path& b, const fs::path& out,
                    const std::vector<std::string>& further = {}) {
  std::vector<std::string> arguments{rds(), "map", "merge", a.string(), b.string(), out.string()};
  arguments.insert(arguments.end(), further.begin(), further.end());
  return run_process(arguments, std::chrono::seconds(60));
}

class MapMerge : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    place = std::make_unique<TemporaryFolder>();
    map("earlier", {"--frames", std::to_string(kEarlierFrames)});
    map("later", {"--start", std::to_string(kLaterStart), "--frames", std::to_string(kLaterFrames)});
  }
  static void TearDownTestSuite() { place.reset(); }

  /// Runs on a part of the recording.
  static void map(const std::string& name, std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--rate", "max", "--no-dynamics"});
    const ProcessResult result = run(rendered_recording("floor"), *place / name, arguments);
    ASSERT_EQ(result.status, 0) << result.standard_error;
  }
  /// Localises a few frames in the merged map. @return the share that has a pose.
  static double found(int start) {
    constexpr int kFrames = 12;
    const std::string name = "found" + std::to_string(start);
    map(name, {"--map", (*place / "merged").string(), "--localize-only", "--start", std::to_string(start),
               "--frames", std::to_string(kFrames)});
    return static_cast<double>(geometry::read_trajectory(*place / name / "trajectory.txt").value().size()) /
           kFrames;
  }
  static double recall(const std::string& name) {
    const auto floor = rendered_recording("floor");
    return evaluation::score_map({floor, floor, *place / name}).value().static_recall;
  }

  /// The later map without one part.
  static fs::path without(const std::string& part) {
    auto sections = map_file::read_saved_map(*place / "later").value();
    sections.erase(part);
    const auto bytes = map_file::to_bytes(sections);
    const fs::path file = *place / ("without_" + part + ".rds");
    write_text(file, {bytes.begin(), bytes.end()});
    return file;
  }

  static inline std::unique_ptr<TemporaryFolder> place;
};

TEST_F(MapMerge, TwoPartsOfAFloorAreOneMap) {
  const std::string earlier = read_text(*place / "earlier/map.rds");
  const ProcessResult result = merge(*place / "earlier", *place / "later", *place / "merged", {"--json"});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  const auto report = nlohmann::json::parse(result.standard_output);
  EXPECT_GE(report["agreeing"].get<int>(), 3);
  EXPECT_GT(report["fused_points"].get<int>(), 100);
  EXPECT_LT(report["residual_m"].get<double>(), 0.02);
  EXPECT_EQ(read_text(*place / "earlier/map.rds"), earlier);

  const auto truth = geometry::read_trajectory(rendered_recording("floor") / "groundtruth.txt").value();
  const auto keyframes = geometry::read_trajectory(*place / "merged/keyframes.txt").value();
  const auto errors = evaluation::evaluate_trajectory(truth, keyframes, {});
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->pairs.size(), report["keyframes"].get<std::size_t>());
  EXPECT_LE(errors->absolute_m.rmse, 0.02);
  const auto figures =
      evaluation::score_map({rendered_recording("floor"), rendered_recording("floor"), *place / "merged"});
  ASSERT_TRUE(figures) << figures.error();
  EXPECT_GE(figures->static_recall, std::min(recall("earlier"), recall("later")) - 0.02);
  EXPECT_GE(figures->precision, 0.99);

  ASSERT_EQ(merge(*place / "earlier", *place / "later", *place / "again").status, 0);
  for (const char* file : {"map.rds", "map.ot", "objects.json", "keyframes.txt"})
    EXPECT_EQ(read_text(*place / "merged" / file), read_text(*place / "again" / file)) << file;

  EXPECT_GE(found(kEarlierFrames / 4), 0.8) << "in the part that only the earlier map has";
  EXPECT_GE(found(kLaterStart + kLaterFrames * 3 / 4), 0.8) << "… the later map has";
}

TEST_F(MapMerge, AMapWithoutTheLoopClosersPartIsMergedAndThatIsSaid) {
  const ProcessResult result = merge(*place / "earlier", without("loop_closer"), *place / "silent");
  ASSERT_EQ(result.status, 0) << result.standard_error;
  EXPECT_THAT(result.standard_output,
              HasSubstr("without_loop_closer.rds was saved without the loop closer's part"));
  EXPECT_THAT(result.standard_output, HasSubstr("map points of both are one"));
}

TEST_F(MapMerge, WhatCannotBeMergedIsSaidInASentenceAndNothingIsWritten) {
  const auto refuse = [&](const fs::path& a, const fs::path& b, const std::string& words) {
    const ProcessResult result = merge(a, b, *place / "refused");
    EXPECT_EQ(result.status, 2) << words;
    EXPECT_THAT(result.standard_error, HasSubstr(words));
    EXPECT_EQ(std::ranges::count(result.standard_error, '\n'), 1) << result.standard_error;
    EXPECT_FALSE(exists(*place / "refused"));
    EXPECT_FALSE(exists(*place / ".refused.merging"));
  };
  const fs::path earlier = *place / "earlier";
  const std::string whole = read_text(*place / "later/map.rds");
  write_text(*place / "torn.rds", whole.substr(0, whole.size() / 2));
  refuse(earlier, *place / "torn.rds", "torn.rds: is torn");
  std::string older = whole;
  older[8] = 3;
  write_text(*place / "older.rds", older);
  refuse(earlier, *place / "older.rds", "has format version 3, expected 4");
  refuse(earlier, *place / "later/map.ot", "is not a saved map");
  refuse(*place / "nowhere", earlier, "nowhere");
  refuse(earlier, without("tracker"), "has no section 'tracker', expected a map that all services saved");
  const ProcessResult there = merge(earlier, *place / "later", *place / "later");
  EXPECT_EQ(there.status, 2);
  EXPECT_THAT(there.standard_error, HasSubstr("is there already"));
  EXPECT_EQ(read_text(*place / "later/map.rds"), whole);

  map("short", {"--start", std::to_string(kOtherRoom), "--frames", "8"});
  refuse(earlier, *place / "short", "keyframes were found, expected 3");
}

}  // namespace
}  // namespace rds::test
