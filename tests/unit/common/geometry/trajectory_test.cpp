// SPDX-License-Identifier: Apache-2.0
#include "common/geometry/trajectory.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::geometry {
namespace {
using testing::HasSubstr;

StampedPose at(std::int64_t stamp_ns, double x, double yaw) {
  return {stamp_ns,
          make_pose({x, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()))), ""};
}

TEST(Trajectory, KeepsDigitsOfStampsAndNanometres) {
  const test::TemporaryFolder folder;
  const std::vector<StampedPose> poses{
      {1305031229528748000, make_pose({1.123456789, -2, 3}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)),
       "1305031229.528748"},
      {1305031230933400000, Pose::Identity(), "1305031230.9334"}};
  ASSERT_TRUE(write_trajectory(folder / "t.txt", poses));
  const auto read = read_trajectory(folder / "t.txt");
  ASSERT_TRUE(read) << read.error();
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[1].stamp_text, "1305031230.9334");
  EXPECT_EQ((*read)[1].stamp_ns, 1305031230933400000);
  EXPECT_TRUE((*read)[0].map_from_camera.isApprox(poses[0].map_from_camera, 1e-9));
  EXPECT_FALSE(std::filesystem::exists(folder / "t.txt.part"));
}

TEST(Trajectory, ReadsCommentsCommasAndExponents) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "t.txt", "# c\n\n1.5,1,2,3,0,0,0,1\r\n+1.75e+00 1 2 3 0 0 0 2\n");
  const auto read = read_trajectory(folder / "t.txt");
  ASSERT_TRUE(read) << read.error();
  EXPECT_EQ(read->at(1).stamp_ns, 1750000000);
  EXPECT_TRUE(read->at(1).map_from_camera.linear().isIdentity(1e-12));
}

TEST(Trajectory, NamesTheBadLine) {
  const test::TemporaryFolder folder;
  for (const char* bad :
       {"2.0 1 2 3", "2.0 1 2 3 0 0 0 0", "2.0 nan 0 0 0 0 0 1", "x 0 0 0 0 0 0 1", "0.5 0 0 0 0 0 0 1"}) {
    test::write_text(folder / "t.txt", std::string("1.0 0 0 0 0 0 0 1\n") + bad + "\n");
    const auto read = read_trajectory(folder / "t.txt");
    ASSERT_FALSE(read) << bad;
    EXPECT_THAT(read.error(), HasSubstr("t.txt:2: ")) << bad;
    EXPECT_THAT(read.error(), HasSubstr("expected")) << bad;
  }
  EXPECT_THAT(read_trajectory(folder / "none.txt").error(), HasSubstr("none.txt"));
}

TEST(Trajectory, ReportsAFolderThatCannotBeWritten) {
  EXPECT_THAT(write_trajectory("/nowhere/t.txt", {}).error(), HasSubstr("/nowhere/t.txt"));
}

TEST(Interpolate, IsLinearAndSpherical) {
  const std::vector<StampedPose> poses{at(0, 0, 0), at(100, 1, 1)};
  const Pose middle = interpolate(poses, 25);
  EXPECT_NEAR(middle.translation().x(), 0.25, 1e-12);
  EXPECT_NEAR(rotation_angle_rad(middle.linear()), 0.25, 1e-12);
}

TEST(Interpolate, HoldsTheEndsAndTheFirstOfEqualStamps) {
  const std::vector<StampedPose> poses{at(0, 5, 0), at(100, 1, 0), at(100, 7, 0), at(200, 3, 0)};
  EXPECT_EQ(interpolate(poses, -10).translation().x(), 5);
  EXPECT_EQ(interpolate(poses, 999).translation().x(), 3);
  EXPECT_NEAR(interpolate(poses, 150).translation().x(), 2, 1e-12);
  EXPECT_THROW(interpolate({}, 0), std::invalid_argument);
}

TEST(PoseAt, NeverReachesBeyondThePosesNorOverAGap) {
  const std::vector<StampedPose> poses{at(0, 0, 0), at(100, 1, 1), at(250, 4, 1)};
  EXPECT_NEAR(pose_at(poses, 25, 100)->translation().x(), 0.25, 1e-12);
  EXPECT_EQ(pose_at(poses, 250, 100)->translation().x(), 4);
  EXPECT_TRUE(pose_at(poses, 101, 150).has_value());
  for (const std::int64_t stamp : {-1, 101, 249, 251}) EXPECT_FALSE(pose_at(poses, stamp, 100)) << stamp;
  EXPECT_FALSE(pose_at({}, 0, 100));
}

}  // namespace
}  // namespace rds::geometry
