// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/process.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(TemporaryFolder, DisappearsWithItsContents) {
  std::filesystem::path path;
  {
    const TemporaryFolder folder;
    path = folder.path();
    write_text(folder / "a/b/c.txt", "x");
    EXPECT_EQ(read_text(folder / "a/b/c.txt"), "x");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Process, GivesStatusAndOutput) {
  const auto result =
      run_process({"sh", "-c", "echo out; echo err >&2; echo $RDS_X; exit 3"}, seconds(10), {{"RDS_X", "7"}});
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(result.standard_output, "out\n7\n");
  EXPECT_EQ(result.standard_error, "err\n");
}

TEST(Process, ReportsSignalsAndMissingPrograms) {
  EXPECT_EQ(run_process({"sh", "-c", "kill -TERM $$"}, seconds(10)).status, 128 + SIGTERM);
  EXPECT_EQ(run_process({"/nowhere/program"}, seconds(10)).status, 127);
}

TEST(Process, IsKilledWithItsChildren) {
  Process process({"sh", "-c", "sleep 100 & echo ready; wait"});
  ASSERT_TRUE(process.wait_for_output("ready", seconds(10)));
  EXPECT_TRUE(process.running());
  EXPECT_FALSE(process.wait(milliseconds(10)));
  process.kill();
  EXPECT_EQ(process.wait(seconds(10)), 128 + SIGKILL);
  EXPECT_FALSE(process.wait_for_output("never", seconds(10)));
}

TEST(Excerpt, HoldsTheChosenFrames) {
  const TemporaryFolder folder;
  make_small_dataset(folder / "whole", 6);
  make_excerpt(folder / "whole", folder / "part", 2, 3);
  EXPECT_EQ(read_text(folder / "part/rgb.txt"),
            "# colour\n10.100000 rgb/10.100000.jpg\n10.133333 rgb/10.133333.jpg\n");
  EXPECT_TRUE(std::filesystem::exists(folder / "part/depth/10.133333.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "part/camera.yaml"));
}

}  // namespace
}  // namespace rds::test
