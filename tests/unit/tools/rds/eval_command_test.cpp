// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/cli/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::tools {
namespace {
using testing::HasSubstr;

struct Outcome {
  int status = 0;
  std::string out;
  std::string err;
};

/// Runs the command in this process.
Outcome run(const std::vector<std::string>& arguments) {
  CLI::App app;
  add_eval_command(app);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Outcome outcome;
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::Error& e) {
    outcome.status = e.get_exit_code();
  }
  std::fflush(stdout);
  outcome.out = testing::internal::GetCapturedStdout();
  outcome.err = testing::internal::GetCapturedStderr();
  return outcome;
}

TEST(EvalCommand, PrintsErrorsAndWritesThePlotBesideTheTrajectory) {
  const test::TemporaryFolder folder;
  test::make_small_dataset(folder.path(), 40);
  std::filesystem::copy(folder / "groundtruth.txt", folder / "trajectory.txt");
  const auto outcome =
      run({"eval", (folder / "groundtruth.txt").string(), (folder / "trajectory.txt").string()});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("pairs 40 of 40 estimated poses\n"));
  EXPECT_THAT(outcome.out, HasSubstr("ATE  m    rmse 0.0000"));
  EXPECT_THAT(outcome.out, HasSubstr("RPE  deg  rmse"));
  EXPECT_TRUE(std::filesystem::exists(folder / "trajectory.png"));
}

TEST(EvalCommand, NamesBadInput) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "a.txt", "1 0 0 0 0 0 0 1\n");
  test::write_text(folder / "b.txt", "1 0 0 0\n");
  const auto malformed = run({"eval", (folder / "a.txt").string(), (folder / "b.txt").string()});
  EXPECT_EQ(malformed.status, 2);
  EXPECT_THAT(malformed.err, HasSubstr("b.txt:1: expected"));
  const auto few = run({"eval", (folder / "a.txt").string(), (folder / "a.txt").string()});
  EXPECT_EQ(few.status, 2);
  EXPECT_THAT(few.err, HasSubstr("at least 3 poses"));
  EXPECT_NE(run({"eval", "a", "b", "--nonsense"}).status, 0);
}

}  // namespace
}  // namespace rds::tools
