// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/play/sensor_choice.hpp"

#include <gmock/gmock.h>

#include "common/image/tum_dataset.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::play {
namespace {

using testing::HasSubstr;

class SensorChoiceTest : public testing::Test {
 protected:
  SensorChoiceTest() { test::make_small_dataset(folder / "tum", 3); }
  auto chosen(const SensorChoice& choice) {
    return chosen_sensors(image::TumDataset::open(folder / "tum").value(), choice);
  }
  std::string fault_of(const SensorChoice& choice) {
    try {
      chosen(choice);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  }
  test::TemporaryFolder folder;
};

TEST_F(SensorChoiceTest, TakesWhatIsAskedForAlone) {
  test::write_text(folder / "tum/imu.txt", "10 0 -9.81 0 0 0 0\n");
  test::write_text(folder / "tum/odometry.txt", "10 0 0 0 0 0 0 1\n");
  EXPECT_FALSE(chosen({}).imu || chosen({}).odometry);
  const auto imu = chosen({.imu = true});
  EXPECT_TRUE(imu.imu && !imu.odometry);
  EXPECT_TRUE(chosen({.odometry = true}).odometry);
}

TEST_F(SensorChoiceTest, PrefersAFileThatIsNamed) {
  test::write_text(folder / "tum/odometry.txt", "10 0 0 0 0 0 0 1\n");
  test::write_text(folder / "other.txt", "10 0 0 0 0 0 0 1\n11 1 0 0 0 0 0 1\n");
  EXPECT_EQ(chosen({.odometry = true, .odometry_file = folder / "other.txt"}).odometry->odom_from_body.size(),
            2U);
  test::write_text(folder / "other.txt", "");
  EXPECT_THAT(fault_of({.odometry = true, .odometry_file = folder / "other.txt"}),
              HasSubstr("at least one pose"));
}

TEST_F(SensorChoiceTest, SaysWhatIsNotThere) {
  EXPECT_THAT(fault_of({.imu = true}), HasSubstr("--imu: expected a recording with an IMU"));
  EXPECT_THAT(fault_of({.odometry = true}), HasSubstr("--odometry: expected a recording with odometry"));
}

}  // namespace
}  // namespace rds::play
