// SPDX-License-Identifier: Apache-2.0
// A run on a recording in another form gives the same bytes.
#include <gmock/gmock.h>

#include "tests/integration/run_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

TEST(ConvertedRun, EveryFormGivesTheSameBytes) {
  const fs::path recording = recording_of_a_room().folder;
  const TemporaryFolder place;
  const auto run_on = [&](const fs::path& dataset, const std::string& name) {
    const auto result = run(dataset, place / name, {"--rate", "max", "--frames", "60", "--no-dynamics"});
    EXPECT_EQ(result.status, 0) << result.standard_error;
  };
  run_on(recording, "tum");
  for (const std::string form : {"a.mcap", "a.db3"}) {
    const fs::path file = place / form;
    const auto converted = run_process({rds(), "convert", recording.string(), file.string()}, 300s);
    ASSERT_EQ(converted.status, 0) << converted.standard_error;
    run_on(file, "out_" + form);
    for (const char* result : {"trajectory.txt", "trajectory_optimized.txt", "keyframes.txt", "map.ot",
                               "objects.json", "grid.pgm"})
      EXPECT_TRUE(read_text(place / ("out_" + form) / result) == read_text(place / "tum" / result))
          << result << " of " << form;
    fs::remove(file);
  }
}

}  // namespace
}  // namespace rds::test
