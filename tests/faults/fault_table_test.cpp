// SPDX-License-Identifier: Apache-2.0
// Five services as processes, one fault each: nothing else ends, nothing hangs, and what the camera and the
// map have become is compared with an undisturbed run.
#include <cstdlib>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/faults/outcome.hpp"
#include "tests/faults/recordings.hpp"
#include "tests/faults/trial.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;

constexpr double kMaxErrorRatio = 1.5;  // to the worst of the undisturbed runs
constexpr double kSmallErrorM =
    0.010;  // … or, in a rendered room, where that has an error of some millimetres
constexpr double kMinRecallRatio = 0.95;
constexpr double kMinLocalized = 0.9;  // of the frames, in an undisturbed run

std::string name_of(const testing::TestParamInfo<Row>& row) {
  return row.param.label();
}

/// Where undisturbed results lie between tests.
fs::path undisturbed_folder(const Row& row) {
  const std::string name = row.moment.name + "_" + bus::name_of(row.vendor) + "_" + row.recording;
  return fs::path(RDS_FAULTS_DIR) / "undisturbed" / name;
}

/// The error that this recording has without a fault, the worst of all undisturbed runs: the length of the
/// run and the vendor make less of a difference than chance does.
double undisturbed_error_m(const fs::path& recording, const Row& row) {
  double worst_m = 0;
  for (const Row& undisturbed : undisturbed_rows()) {
    const fs::path out = undisturbed_folder(undisturbed);
    if (undisturbed.recording == row.recording && fs::exists(out / "map.ot"))
      worst_m = std::max(worst_m, figures_of(recording, out, out).ate_final_m);
  }
  return worst_m;
}

/// A test that failed leaves its logs there.
void keep_logs(const Row& row, const fs::path& out) {
  if (!testing::Test::HasFailure()) return;
  const fs::path kept = fs::path(RDS_FAULTS_DIR) / "failed" / row.label();
  fs::remove_all(kept);
  fs::create_directories(kept);
  fs::copy(out / "log", kept, fs::copy_options::recursive);
  fs::copy(out / "frames.csv", kept);
}

void expect_no_other_ends(const Row& row, const Trial::Report& report) {
  for (const auto& [service, ends] : report.ends)
    EXPECT_EQ(ends, service == row.service ? row.expected_ends() : std::vector<int>{}) << service;
  EXPECT_THAT(report.faults, IsEmpty());
}

/// In parentheses what the undisturbed run has.
void print(const Row& row, const Trial::Report& report, const Figures& figures, const Figures& expected) {
  fmt::print("{}: ATE live {:.4f} ({:.4f}) final {:.4f} ({:.4f}) m, recall {:.3f} ({:.3f}), ", row.label(),
             figures.ate_live_m, expected.ate_live_m, figures.ate_final_m, expected.ate_final_m,
             figures.recall, expected.recall);
  fmt::print("{} of {} frames localised, {} of {} keyframes mapped\n", report.localized, report.frames,
             report.integrated, report.keyframes);
}

class Undisturbed : public testing::TestWithParam<Row> {};

TEST_P(Undisturbed, IsWhatOthersAreComparedWith) {
  const Row& row = GetParam();
  const fs::path out = undisturbed_folder(row);
  fs::remove_all(out);
  fs::create_directories(out);
  const TemporaryFolder place;
  const fs::path recording = to_and_fro(row.recording, place.path());
  const Trial::Report report = Trial(recording, row, row.timing(), out).run();
  expect_no_other_ends(row, report);
  EXPECT_GE(static_cast<double>(report.localized), kMinLocalized * static_cast<double>(report.frames));
  const Figures figures = figures_of(recording, out, out);
  print(row, report, figures, figures);
  fs::remove_all(out / "maps");
}

class FaultTable : public testing::TestWithParam<Row> {};

TEST_P(FaultTable, IsSurvived) {
  const Row& row = GetParam();
  const fs::path undisturbed = undisturbed_folder(row);
  ASSERT_TRUE(fs::exists(undisturbed / "map.ot")) << "run by ctest, which makes " << undisturbed << " first";
  const TemporaryFolder place;
  const fs::path recording = to_and_fro(row.recording, place.path());
  const Trial::Report report = Trial(recording, row, row.timing(), place / "out").run();
  expect_no_other_ends(row, report);
  const Figures expected = figures_of(recording, undisturbed, undisturbed);
  const Figures figures = figures_of(recording, place / "out", undisturbed);
  print(row, report, figures, expected);
  const double small_m = why_not_shared("data").empty() ? 0 : kSmallErrorM;
  EXPECT_LE(figures.ate_final_m, std::max(kMaxErrorRatio * undisturbed_error_m(recording, row), small_m));
  EXPECT_GE(figures.recall, kMinRecallRatio * expected.recall);
  keep_logs(row, place / "out");
}

INSTANTIATE_TEST_SUITE_P(Before, Undisturbed, testing::ValuesIn(undisturbed_rows()), name_of);
INSTANTIATE_TEST_SUITE_P(Each, FaultTable, testing::ValuesIn(fault_table()), name_of);

}  // namespace
}  // namespace rds::test
