// SPDX-License-Identifier: Apache-2.0
// The first moment of the fault table in processes built with a sanitizer: none may report anything, end or
// hang. The camera runs slowly, as they do.
#include <cstdlib>

#include <gmock/gmock.h>

#include "tests/faults/recordings.hpp"
#include "tests/faults/trial.hpp"
#include "tests/support/sanitizers/reports.hpp"

namespace rds::test {
namespace {

using ::testing::IsEmpty;

constexpr Timing kTiming{.at_s = 3, .lasts_s = 2, .total_s = 8, .rate = 0.2};
constexpr int kPatience = 6;

class SanitizedFaults : public testing::TestWithParam<Row> {
 protected:
  SanitizedFaults() {
    for (const auto& [name, value] : reports_.environment()) {
      const char* was = std::getenv(name.c_str());
      before_[name] = was == nullptr ? "" : was;
      setenv(name.c_str(), value.c_str(), 1);
    }
  }
  ~SanitizedFaults() override {
    for (const auto& [name, value] : before_) setenv(name.c_str(), value.c_str(), 1);
  }

  SanitizerReports reports_;
  Process::Environment before_;
};

TEST_P(SanitizedFaults, NothingIsReported) {
  const Row& row = GetParam();
  const TemporaryFolder place;
  const Trial::Report report = Trial(to_and_fro(row.recording, place.path()), row, kTiming, place / "out", kPatience).run();
  for (const auto& [service, ends] : report.ends)
    EXPECT_EQ(ends, service == row.service ? row.expected_ends() : std::vector<int>{}) << service;
  EXPECT_THAT(report.faults, IsEmpty());
  EXPECT_THAT(reports_.found(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(AtBegin, SanitizedFaults, testing::ValuesIn(rows_at_begin()),
                         [](const auto& row) { return row.param.label(); });

}  // namespace
}  // namespace rds::test
