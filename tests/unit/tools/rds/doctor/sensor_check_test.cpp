// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/sensor_check.hpp"

#include <gmock/gmock.h>

#include "common/image/tum_dataset.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::doctor {
namespace {

using testing::HasSubstr;

const std::vector<std::int64_t> kFrames{100, 200, 300, 400};

TEST(SensorCheck, IsGoodWhereAllFramesLieBetweenMeasurements) {
  const auto finding = check_sensor("IMU", kFrames, std::vector<std::int64_t>{100, 150, 250, 350, 450}, 100);
  EXPECT_EQ(finding.verdict, Verdict::kGood);
  EXPECT_THAT(finding.sentence, HasSubstr("5 measurements; 4 of 4 frames"));
}

TEST(SensorCheck, CountsFramesInGapsAndBeyondTheEnds) {
  const auto finding = check_sensor("IMU", kFrames, std::vector<std::int64_t>{150, 210, 390}, 100);
  EXPECT_EQ(finding.verdict, Verdict::kHint);
  EXPECT_THAT(finding.sentence, HasSubstr("1 of 4 frames"));
  EXPECT_THAT(check_sensor("IMU", kFrames, {}, 100).sentence, HasSubstr("0 of 4 frames"));
}

TEST(SensorCheck, IsOfWhatTheRecordingHas) {
  const test::TemporaryFolder folder;
  test::make_small_dataset(folder.path(), 5);
  EXPECT_TRUE(check_sensors(image::TumDataset::open(folder.path()).value()).empty());
  test::write_text(folder / "odometry.txt", "9.9 0 0 0 0 0 0 1\n10.3 0.5 0 0 0 0 0 1\n");
  test::write_text(folder / "imu.txt", "10 0 -9.81 0\n10.01 0 -9.81 0\n");
  const auto findings = check_sensors(image::TumDataset::open(folder.path()).value());
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_EQ(findings[0].subject, "odometry");
  EXPECT_EQ(findings[0].verdict, Verdict::kGood);
  EXPECT_EQ(findings[1].subject, "IMU");
  EXPECT_EQ(findings[1].verdict, Verdict::kHint) << "it ends after the first frame";
}

}  // namespace
}  // namespace rds::doctor
