// SPDX-License-Identifier: Apache-2.0
// A tracker that reads an IMU beside the camera: its gyroscope is turned into the camera's frame by tf,
// compared with vision, and what comes of that is told.
#include <algorithm>
#include <thread>

#include <gmock/gmock.h>

#include "common/messages/conversions.hpp"
#include "sensor_msgs/msg/Imu.h"
#include "tests/integration/camera/camera_driver.hpp"
#include "tests/integration/camera/told_diagnostics.hpp"
#include "tests/support/test_domain.hpp"
#include "tf2_msgs/msg/TFMessage.h"
#include "tools/simulator/sensors/gyroscope.hpp"

namespace rds::test {
namespace {

using ::testing::HasSubstr;

const std::string kOptical = "camera_color_optical_frame";
const Eigen::Quaterniond kCameraFromImu(-0.5, 0.5, -0.5, 0.5);

class GyroscopeInput : public ::testing::Test {
 protected:
  GyroscopeInput() {
    static_ = driver_.bus().advertise<tf2_msgs::msg::TFMessage>("/tf_static", bus::kLatched);
    imu_ = driver_.bus().advertise<sensor_msgs::msg::Imu>("imu", {.reliable = true, .depth = 2000});
  }

  void publish_mounting(const Eigen::Quaterniond& camera_from_imu) {
    geometry_msgs::msg::TransformStamped mounting;
    mounting.header(messages::make_header(0, kOptical));
    mounting.child_frame_id("imu_link");
    mounting.transform(messages::to_transform_message(geometry::make_pose({0.01, 0, 0}, camera_from_imu)));
    tf2_msgs::msg::TFMessage tree;
    tree.transforms().push_back(mounting);
    static_.write(tree);
  }
  /// What a gyroscope that stands as kCameraFromImu says tells of the recording, then the recording.
  /// @param more  that it also tells [rad/s].
  void track_with_imu(const Eigen::Vector3d& more = Eigen::Vector3d::Zero()) {
    const auto truth = TrackerWithDriver::truth();
    const std::int64_t end_ns = TrackerWithDriver::frames().back().stamp_ns + 100'000'000;
    for (const auto& rate : simulator::gyroscope(truth, {.rate_hz = 100, .delay_ns = 0}, 1)) {
      if (rate.stamp_ns > end_ns) break;
      const Eigen::Vector3d in_imu = kCameraFromImu.conjugate() * rate.rad_per_s + more;
      sensor_msgs::msg::Imu message;
      message.header(messages::make_header(rate.stamp_ns, "imu_link"));
      message.angular_velocity().x(in_imu.x());
      message.angular_velocity().y(in_imu.y());
      message.angular_velocity().z(in_imu.z());
      imu_.write(message);
    }
    std::this_thread::sleep_for(1s);  // the tracker has them, and tf, before the first frame
    for (std::size_t i = 0; i < TrackerWithDriver::frames().size(); ++i) driver_.track(i);
    std::this_thread::sleep_for(2500ms);  // diagnostics come once a second
  }

  TrackerWithDriver driver_{bus::Vendor::kFastDds, test_domain(), {}, "{inputs: {imu: imu}}"};
  bus::Publisher<tf2_msgs::msg::TFMessage> static_;
  bus::Publisher<sensor_msgs::msg::Imu> imu_;
  ToldDiagnostics told{driver_.bus()};
};

TEST_F(GyroscopeInput, IsRightWhereTfSaysHowItIsMounted) {
  publish_mounting(kCameraFromImu);
  track_with_imu();
  EXPECT_GT(std::atoi(told("imu messages").c_str()), 100) << driver_.log();
  EXPECT_EQ(told("gyroscope windows refused"), "0");
}

TEST_F(GyroscopeInput, IsFoundWrongWhereItTurnsAndTheCameraDoesNot) {
  publish_mounting(kCameraFromImu);
  track_with_imu({0, 0, 1});
  EXPECT_GT(std::atoi(told("gyroscope windows refused").c_str()), 0) << driver_.log();
  EXPECT_EQ(told("turns by the gyroscope"), "0");
}

TEST_F(GyroscopeInput, ThatNoTfJoinsToTheCameraIsAWarning) {
  track_with_imu();
  EXPECT_THAT(driver_.log(), HasSubstr("imu tells of a frame that no tf joins with the camera's"));
}

}  // namespace
}  // namespace rds::test
