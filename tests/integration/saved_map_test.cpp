// SPDX-License-Identifier: Apache-2.0
// A saved map: going on in it, localising in it alone, and what is refused.
#include <fstream>

#include <gmock/gmock.h>

#include "tests/integration/run_support.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// frames.csv: the states, frame by frame.
std::vector<std::string> states(const fs::path& out) {
  std::ifstream table(out / "frames.csv");
  std::vector<std::string> states;
  std::string line;
  std::getline(table, line);
  while (std::getline(table, line)) {
    const auto begin = line.find(',') + 1;
    states.push_back(line.substr(begin, line.find(',', begin) - begin));
  }
  return states;
}

void expect_same_files(const fs::path& a, const fs::path& b, const std::vector<std::string>& files) {
  for (const std::string& file : files) EXPECT_EQ(read_text(a / file), read_text(b / file)) << file;
}

/// Maps the first frames of a recording without people, and goes on from there.
class SavedMap : public ::testing::Test {
 protected:
  fs::path recording() const { return room.folder; }
  fs::path first() const { return place / "first"; }
  void map_first(std::size_t frames) const {
    const ProcessResult result =
        run(recording(), first(), {"--rate", "max", "--no-dynamics", "--frames", std::to_string(frames)});
    ASSERT_EQ(result.status, 0) << result.standard_error;
  }
  ProcessResult go_on(const fs::path& dataset, const fs::path& out,
                      std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--rate", "max", "--map", first().string()});
    return run(dataset, out, arguments);
  }

  const TestRecording room = recording_of_a_room();
  const std::size_t mapped = room.frames * 3 / 5;
  TemporaryFolder place;
};

TEST_F(SavedMap, ALaterPartIsMappedOnInItWithTheSameBytesOverEachBus) {
  ASSERT_NO_FATAL_FAILURE(map_first(mapped));
  const std::size_t start = room.frames / 2;
  const std::string mixed = "tracker=cyclonedds,mapper=fastdds";
  const std::string last = all_vendor_names().back();
  for (const std::string& bus : {mixed, last}) {
    const ProcessResult result =
        go_on(recording(), place / bus, {"--no-dynamics", "--start", std::to_string(start), "--bus", bus});
    ASSERT_EQ(result.status, 0) << result.standard_error;
  }
  const auto found = states(place / mixed);
  ASSERT_EQ(found.size(), room.frames - start);
  const auto relocalised = std::ranges::find(found, "RELOCALISED");
  EXPECT_LT(relocalised - found.begin(), 5);
  EXPECT_EQ(std::count(found.begin(), relocalised, "LOST"), relocalised - found.begin())
      << "no pose is invented";
  const auto figures = score(recording(), place / mixed);
  EXPECT_LE(figures["ate_final"].get<double>(), room.bound(0.070, 0.010));
  expect_same_files(place / mixed, place / last,
                    {"trajectory.txt", "trajectory_optimized.txt", "keyframes.txt", "map.ot", "map.rds"});
  EXPECT_GT(fs::file_size(place / mixed / "map.rds"), fs::file_size(first() / "map.rds"));
}

TEST_F(SavedMap, LocalizeOnlyTracksAndLeavesTheMapByteForByte) {
  ASSERT_NO_FATAL_FAILURE(map_first(mapped));
  const auto out = place / "localized";
  const ProcessResult result = go_on(recording(), out, {"--no-dynamics", "--localize-only"});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  const auto figures = score(recording(), out);
  EXPECT_GE(figures["tracked"].get<double>(), 0.98);
  EXPECT_LE(figures["ate_final"].get<double>(), room.bound(0.080, 0.010));
  expect_same_files(first(), out, {"map.ot", "map.rds", "objects.json", "grid.pgm", "grid.yaml"});
}

TEST_F(SavedMap, LocalizeOnlyRemovesPeopleAndLeavesTheMap) {
  ASSERT_NO_FATAL_FAILURE(map_first(mapped));
  const auto out = place / "walkers";
  const auto dataset = recording_with_people().folder;
  const ProcessResult result = go_on(dataset, out, {"--localize-only"});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  const auto figures = score(dataset, out);
  EXPECT_GE(figures["tracked"].get<double>(), 0.9);
  EXPECT_GE(figures["box_recall"].get<double>(), 0.6);
  EXPECT_LE(figures["ate_final"].get<double>(), room.bound(0.080, 0.010));
  expect_same_files(first(), out, {"map.ot", "map.rds"});
}

TEST_F(SavedMap, AnOctreeAloneIsMappedOnFromTheOrigin) {
  ASSERT_NO_FATAL_FAILURE(map_first(20));
  const auto out = place / "octree";
  const ProcessResult result =
      run(recording(), out,
          {"--rate", "max", "--no-dynamics", "--frames", "20", "--map", (first() / "map.ot").string()});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  EXPECT_THAT(result.standard_error, HasSubstr("map.ot: an octree alone"));
  EXPECT_EQ(states(out).front(), "TRACKING");
  EXPECT_GE(fs::file_size(out / "map.ot"), fs::file_size(first() / "map.ot"));
}

TEST_F(SavedMap, AFileThatIsTornAlteredOrOfAnotherKindIsRefused) {
  ASSERT_NO_FATAL_FAILURE(map_first(20));
  const auto refuse = [&](const fs::path& map, const std::string& words) {
    const ProcessResult result =
        run(recording(), place / "refused", {"--rate", "max", "--map", map.string()});
    EXPECT_EQ(result.status, 2) << words;
    EXPECT_THAT(result.standard_error, testing::AllOf(HasSubstr(map.string()), HasSubstr(words)));
    EXPECT_FALSE(exists(place / "refused"));
  };
  const std::string whole = read_text(first() / "map.rds");
  write_text(place / "torn.rds", whole.substr(0, whole.size() / 2));
  refuse(place / "torn.rds", "is torn");
  std::string altered = whole;
  altered[altered.size() / 2] = static_cast<char>(~altered[altered.size() / 2]);
  write_text(place / "altered.rds", altered);
  refuse(place / "altered.rds", "another checksum");
  refuse(recording() / "rgb.txt", "is not a saved map");
  refuse(place / "nowhere.rds", "cannot be read");
  refuse(recording(), "holds no saved map");
}

TEST_F(SavedMap, AMapThatTheSettingsDoNotFitIsRefusedByTheService) {
  ASSERT_NO_FATAL_FAILURE(map_first(20));
  write_text(place / "coarse.yaml", "mapper: {octree: {resolution_m: 0.1}}\n");
  const ProcessResult result =
      go_on(recording(), place / "coarse", {"--no-dynamics", "--config", (place / "coarse.yaml").string()});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.standard_error, HasSubstr("voxels of 0.05 m, expected 0.1 m"));
}

TEST(LocalizeOnly, NeedsAMapToLocaliseIn) {
  const TemporaryFolder place;
  make_small_dataset(place / "data", 6);
  const ProcessResult result = run(place / "data", place / "out", {"--localize-only"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.standard_error, HasSubstr("--localize-only: expected --map"));
}

}  // namespace
}  // namespace rds::test
