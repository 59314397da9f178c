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

// Of the recording: the earlier part goes from a corridor into a room, the later one from that room back
// into another part of the corridor.
constexpr int kEarlierFrames = 170;
constexpr int kLaterStart = 130;
constexpr int kLaterFrames = 135;

ProcessResult merge(const fs::path& a, const fs::path& b, const fs::path& out,
                    const std::vector<std::string>& further = {}) {
  std::vector<std::string> arguments{rds(), "map", "merge", a.string(), b.string(), out.string()};
  arguments.insert(arguments.end(), further.begin(), further.end());
  return run_process(arguments, std::chrono::seconds(60));
}

/// Two runs on parts of the floor. One test looks at all that is made of them, as each test is a process.
class MapMerge : public ::testing::Test {
 protected:
  /// Runs on a part of the recording.
  void map(const std::string& name, std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--rate", "max", "--no-dynamics"});
    const ProcessResult result = run(floor, place / name, arguments);
    ASSERT_EQ(result.status, 0) << result.standard_error;
  }
  /// Localises a few frames in the merged map. @return the share that has a pose.
  double found_from(int start) const {
    constexpr int kFrames = 12;
    const std::string name = "found" + std::to_string(start);
    map(name, {"--map", (place / "merged").string(), "--localize-only", "--start", std::to_string(start),
               "--frames", std::to_string(kFrames)});
    return static_cast<double>(geometry::read_trajectory(place / name / "trajectory.txt").value().size()) /
           kFrames;
  }
  /// The later map without one part.
  fs::path without(const std::string& part) const {
    auto sections = map_file::read_saved_map(place / "later").value();
    sections.erase(part);
    const auto bytes = map_file::to_bytes(sections);
    const fs::path file = place / ("without_" + part + ".rds");
    write_text(file, {bytes.begin(), bytes.end()});
    return file;
  }

  void expect_one_frame(const nlohmann::json& report) const;
  void expect_the_surfaces_of_both() const;
  void expect_refused(const fs::path& a, const fs::path& b, const std::string& words) const;

  const fs::path floor = rendered_recording("floor");
  TemporaryFolder place;
};

void MapMerge::expect_one_frame(const nlohmann::json& report) const {
  EXPECT_GE(report["agreeing"].get<int>(), 3);
  EXPECT_GT(report["fused_points"].get<int>(), 100);
  EXPECT_LT(report["residual_m"].get<double>(), 0.02);
  const auto truth = geometry::read_trajectory(floor / "groundtruth.txt").value();
  const auto keyframes = geometry::read_trajectory(place / "merged/keyframes.txt").value();
  EXPECT_EQ(keyframes.size(), report["keyframes"].get<std::size_t>());
  const auto errors = evaluation::evaluate_trajectory(truth, keyframes, {});
  ASSERT_TRUE(errors);
  EXPECT_GE(errors->pairs.size(), keyframes.size() * 3 / 4) << "one of two that both have of a frame";
  EXPECT_LE(errors->absolute_m.rmse, 0.012);
}

void MapMerge::expect_the_surfaces_of_both() const {
  constexpr int kEvery = 20;  // frames: enough to see all surfaces
  const auto merged = evaluation::score_map({floor, floor, place / "merged", kEvery});
  ASSERT_TRUE(merged) << merged.error();
  EXPECT_GE(merged->static_recall, 0.98) << "one run over all frames has 1.000";
  EXPECT_GE(merged->precision, 0.99);
}

void MapMerge::expect_refused(const fs::path& a, const fs::path& b, const std::string& words) const {
  const ProcessResult result = merge(a, b, place / "refused");
  EXPECT_EQ(result.status, 2) << words;
  EXPECT_THAT(result.standard_error, HasSubstr(words));
  EXPECT_EQ(std::ranges::count(result.standard_error, '\n'), 1) << result.standard_error;
  EXPECT_FALSE(exists(place / "refused"));
  EXPECT_FALSE(exists(place / ".refused.merging"));
}

TEST_F(MapMerge, TwoPartsOfAFloorAreOneMapAndWhatIsNoMapIsRefused) {
  ASSERT_NO_FATAL_FAILURE(map("earlier", {"--frames", std::to_string(kEarlierFrames)}));
  ASSERT_NO_FATAL_FAILURE(
      map("later", {"--start", std::to_string(kLaterStart), "--frames", std::to_string(kLaterFrames)}));
  const fs::path earlier = place / "earlier";
  const std::string earlier_bytes = read_text(earlier / "map.rds");
  const std::string later_bytes = read_text(place / "later/map.rds");

  const ProcessResult result = merge(earlier, place / "later", place / "merged", {"--json"});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  ASSERT_NO_FATAL_FAILURE(expect_one_frame(nlohmann::json::parse(result.standard_output)));
  expect_the_surfaces_of_both();
  EXPECT_GE(found_from(kEarlierFrames / 4), 0.8) << "in the part that only the earlier map has";
  EXPECT_GE(found_from(kLaterStart + kLaterFrames - 20), 0.8) << "… the later map has";

  ASSERT_EQ(merge(earlier, place / "later", place / "again").status, 0);
  for (const char* file : {"map.rds", "map.ot", "objects.json", "keyframes.txt"})
    EXPECT_EQ(read_text(place / "merged" / file), read_text(place / "again" / file)) << file;
  const ProcessResult silent = merge(earlier, without("loop_closer"), place / "silent");
  EXPECT_THAT(silent.standard_output,
              HasSubstr("without_loop_closer.rds was saved without the loop closer's part"));
  EXPECT_THAT(silent.standard_output, HasSubstr("map points of both are one"));

  write_text(place / "torn.rds", later_bytes.substr(0, later_bytes.size() / 2));
  expect_refused(earlier, place / "torn.rds", "torn.rds: is torn");
  std::string older = later_bytes;
  older[8] = 3;  // the format's version
  write_text(place / "older.rds", older);
  expect_refused(earlier, place / "older.rds", "has format version 3, expected 4");
  expect_refused(earlier, place / "later/map.ot", "is not a saved map");
  expect_refused(place / "nowhere", earlier, "nowhere");
  expect_refused(earlier, without("tracker"),
                 "has no section 'tracker', expected a map that all services saved");
  EXPECT_THAT(merge(earlier, place / "later", place / "later").standard_error, HasSubstr("is there already"));
  EXPECT_EQ(read_text(earlier / "map.rds"), earlier_bytes) << "neither is changed";
  EXPECT_EQ(read_text(place / "later/map.rds"), later_bytes);
}

}  // namespace
}  // namespace rds::test
