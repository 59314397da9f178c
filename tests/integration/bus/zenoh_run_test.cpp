// SPDX-License-Identifier: Apache-2.0
// A whole run over Zenoh gives what it gives over DDS, byte for byte.
#include <gtest/gtest.h>

#include "tests/integration/run_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

TEST(ZenohRun, GivesTheSameBytesAsDds) {
  const TemporaryFolder place;
  const auto dataset = recording_with_people().folder;
  for (const char* bus : {"fastdds", "zenoh"}) {
    const ProcessResult result = run(dataset, place / bus, {"--rate", "max", "--frames", "90", "--bus", bus});
    ASSERT_EQ(result.status, 0) << bus << ": " << result.standard_error;
  }
  for (const char* file : {"trajectory.txt", "trajectory_optimized.txt", "keyframes.txt", "detections.jsonl",
                           "predictions.jsonl", "map.ot", "map.rds", "objects.json"}) {
    const std::string expected = read_text(place / "fastdds" / file);
    EXPECT_FALSE(expected.empty()) << file;
    EXPECT_EQ(expected, read_text(place / "zenoh" / file)) << file;
  }
}

TEST(ZenohRun, MeetsNoDds) {
  const TemporaryFolder place;
  const auto dataset = recording_of_a_room().folder;
  const ProcessResult result = run(dataset, place / "out", {"--bus", "tracker=zenoh"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.standard_error,
            "--bus: expected zenoh for all processes or for none, it does not meet DDS\n");
}

}  // namespace
}  // namespace rds::test
