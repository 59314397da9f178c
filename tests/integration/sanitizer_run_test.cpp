// SPDX-License-Identifier: Apache-2.0
// A short run of the real processes, people in the picture, on each bus, in lockstep and in real time: built
// with a sanitizer, no process may report anything.
#include <gmock/gmock.h>

#include "tests/integration/run_support.hpp"
#include "tests/support/sanitizers/reports.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

struct RunMode {
  std::string name;
  std::string bus;
  std::string rate;
};

void PrintTo(const RunMode& mode, std::ostream* out) {
  *out << mode.name;
}

class SanitizedRun : public ::testing::TestWithParam<RunMode> {};

TEST_P(SanitizedRun, IsCleanInEveryProcess) {
  const TemporaryFolder place;
  const SanitizerReports reports;
  // A sanitizer makes everything ten times slower.
  write_text(place / "slow.yaml", "tracker: {lockstep_timeout_s: 300}\n");
  const ProcessResult result = run(recording_with_people().folder, place / "out",
                                   {"--start", "20", "--frames", "40", "--bus", GetParam().bus, "--rate",
                                    GetParam().rate, "--config", (place / "slow.yaml").string()},
                                   std::chrono::minutes(10), reports.environment());
  EXPECT_THAT(reports.found(), ::testing::IsEmpty());
  EXPECT_EQ(result.status, 0) << result.standard_error;
}

INSTANTIATE_TEST_SUITE_P(Both, SanitizedRun,
                         ::testing::Values(RunMode{"fastdds_lockstep", "fastdds", "max"},
                                           RunMode{"cyclonedds_lockstep", "cyclonedds", "max"},
                                           RunMode{"fastdds_real_time", "fastdds", "0.2"},
                                           RunMode{"cyclonedds_real_time", "cyclonedds", "0.2"}),
                         [](const auto& mode) { return mode.param.name; });

}  // namespace
}  // namespace rds::test
