// SPDX-License-Identifier: Apache-2.0
// Whole runs of the real processes on recordings, against the figures that the project promises.
#include <gmock/gmock.h>

#include "tests/integration/run_support.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

TEST(RecordedRun, TracksATurningCameraInAnOffice) {
  RDS_REQUIRE_SHARED("data/tum_fr1_rpy");
  const TemporaryFolder place;
  const auto dataset = shared() / "data/tum_fr1_rpy";
  const ProcessResult result = run(dataset, place / "out", {"--rate", "max", "--no-dynamics"});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  const auto figures = score(dataset, place / "out");
  EXPECT_EQ(figures["tracked"].get<double>(), 1.0) << "two pictures have no depth";
  EXPECT_LE(figures["ate_final"].get<double>(), 0.040);
}

TEST(RecordedRun, TracksACameraThatComesBackInAKitchen) {
  RDS_REQUIRE_SHARED("data/7scenes_kitchen");
  const TemporaryFolder place;
  const auto dataset = shared() / "data/7scenes_kitchen";
  const ProcessResult result = run(dataset, place / "out", {"--rate", "max", "--no-dynamics"});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  const auto figures = score(dataset, place / "out");
  EXPECT_EQ(figures["tracked"].get<double>(), 1.0);
  EXPECT_LE(figures["ate_final"].get<double>(), 0.070);
}

TEST(RecordedRun, KeepsPeopleOutOfPoseAndMapAndGivesTheSameBytesOverEachBus) {
  const TemporaryFolder place;
  const TestRecording recording = recording_with_people();
  const auto dataset = recording.folder;
  const std::vector<std::string> buses = all_vendor_names();
  for (const std::string& bus : buses) {
    const ProcessResult result = run(dataset, place / bus, {"--rate", "max", "--bus", bus});
    ASSERT_EQ(result.status, 0) << bus << ": " << result.standard_error;
  }
  const auto figures = score(dataset, place / buses.front(), recording_of_a_room().folder);
  EXPECT_GE(figures["tracked"].get<double>(), 1.0);
  EXPECT_LE(figures["ate_final"].get<double>(), recording.bound(0.056, 0.010));
  EXPECT_GE(figures["box_recall"].get<double>(), recording.bound(0.94, 0.80));
  EXPECT_LE(figures["residue"].get<double>(), recording.bound(0.02, 0.01));
  EXPECT_GE(figures["static_recall"].get<double>(), recording.bound(0.85, 0.97));
  EXPECT_GE(figures["map_precision"].get<double>(), 0.965);
  for (const char* file : {"trajectory.txt", "trajectory_optimized.txt", "keyframes.txt", "detections.jsonl",
                           "predictions.jsonl", "map.ot", "map.rds", "objects.json"}) {
    const std::string expected = read_text(place / buses.front() / file);
    EXPECT_FALSE(expected.empty()) << file;
    for (const std::string& bus : buses)
      EXPECT_TRUE(read_text(place / bus / file) == expected) << file << " of " << bus;
  }
}

}  // namespace
}  // namespace rds::test
