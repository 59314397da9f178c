// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/input/pose_file.hpp"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::tracker {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(PoseFile, GivesPosesBetweenNearNeighboursOnly) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "poses.txt",
                   "# stamp tx ty tz qx qy qz qw\n1.0 0 0 0 0 0 0 1\n1.1 1 0 0 0 0 0 1\n2.0 5 0 0 0 0 0 1\n");
  const GivenPoses poses = read_given_poses(folder / "poses.txt", 0.1);
  EXPECT_NEAR(poses(1'050'000'000)->translation().x(), 0.5, 1e-12);
  EXPECT_EQ(poses(2'000'000'000)->translation().x(), 5);
  EXPECT_FALSE(poses(1'500'000'000));
}

TEST(PoseFile, NoFileMeansEstimatedPoses) {
  EXPECT_FALSE(read_given_poses("", 0.1));
}

TEST(PoseFile, ABadFileIsNamed) {
  const test::TemporaryFolder folder;
  const auto read = [&] { read_given_poses(folder / "poses.txt", 0.1); };
  EXPECT_THAT(read, ThrowsMessage<std::runtime_error>(HasSubstr("poses.txt: cannot be read")));
  test::write_text(folder / "poses.txt", "# nothing\n");
  EXPECT_THAT(read, ThrowsMessage<std::runtime_error>(HasSubstr("poses.txt: expected at least one pose")));
  test::write_text(folder / "poses.txt", "1.0 0 0 0 0 0 0 1\n2.0 0 0 nan 0 0 0 1\n");
  EXPECT_THAT(read, ThrowsMessage<std::runtime_error>(HasSubstr("poses.txt:2: expected")));
}

}  // namespace
}  // namespace rds::tracker
