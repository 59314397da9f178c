// SPDX-License-Identifier: Apache-2.0
#include "common/image/sensors/imu_file.hpp"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace rds::image {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ImuFile : public testing::Test {
 protected:
  auto read(const std::string& text) {
    test::write_text(file, text);
    return read_imu(file);
  }
  test::TemporaryFolder folder;
  std::filesystem::path file = folder / "imu.txt";
};

TEST_F(ImuFile, IsReadToTheNanosecond) {
  const auto track = read("# stamp a w\n1.5 1 2 3 4 5 6\n1.5 9 9 9 9 9 9\n1.500000001 0 -9.81 0 0 0 1e-3\n");
  ASSERT_TRUE(track) << track.error();
  EXPECT_TRUE(track->has_gyroscope);
  ASSERT_EQ(track->measurements.size(), 2U) << "a stamp counts once";
  EXPECT_EQ(track->measurements[0].acceleration, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(track->measurements[0].turn_rate, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(track->measurements[1].stamp_ns, 1'500'000'001);
  EXPECT_EQ(track->measurements[1].turn_rate.z(), 1e-3);
}

TEST_F(ImuFile, MayHaveNoGyroscope) {
  const auto track = read("1 0 -9.81 0\n2 0 -9.8 0\n");
  ASSERT_TRUE(track) << track.error();
  EXPECT_FALSE(track->has_gyroscope);
  EXPECT_EQ(track->measurements[1].acceleration.y(), -9.8);
}

TEST_F(ImuFile, ThatIsWrongIsRefusedWithItsLine) {
  EXPECT_THAT(read("1 0 0 0\n2 0 0 0 0 0 0\n").error(), AllOf(HasSubstr("imu.txt:2"), HasSubstr("expected")));
  EXPECT_THAT(read("1 0 0 0 0 0 x\n").error(), HasSubstr("imu.txt:1: expected `timestamp ax"));
  EXPECT_THAT(read("-1 0 0 0\n").error(), HasSubstr("imu.txt:1"));
  EXPECT_THAT(read("2 0 0 0\n1 0 0 0\n").error(), HasSubstr("imu.txt:2: stamp 1 goes back"));
  EXPECT_THAT(read("# nothing\n").error(), HasSubstr("at least one"));
  EXPECT_THAT(read_imu(folder / "none.txt").error(), HasSubstr("none.txt"));
}

TEST_F(ImuFile, IsWrittenInTheCamerasAxes) {
  ImuTrack track;
  track.camera_from_imu = geometry::make_pose({1, 2, 3}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5));
  track.measurements = {{1'250'000'000, {0, 0, 9.81}, {0.1, 0.2, 0.3}}};
  const auto again = read(imu_lines(track));
  ASSERT_TRUE(again) << again.error();
  ASSERT_EQ(again->measurements.size(), 1U);
  EXPECT_EQ(again->measurements[0].stamp_ns, 1'250'000'000);
  EXPECT_TRUE(again->measurements[0].acceleration.isApprox(Eigen::Vector3d(0, -9.81, 0), 1e-9));
  EXPECT_TRUE(again->measurements[0].turn_rate.isApprox(Eigen::Vector3d(-0.2, -0.3, 0.1), 1e-9));
  track.has_gyroscope = false;
  EXPECT_FALSE(read(imu_lines(track))->has_gyroscope);
}

}  // namespace
}  // namespace rds::image
