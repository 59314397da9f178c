// SPDX-License-Identifier: Apache-2.0
// A tracker that reads an IMU beside the camera: its gyroscope is turned into the camera's frame by tf,
// compared with vision, and what comes of that is told.
#include <algorithm>
#include <functional>
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
constexpr std::int64_t kMastNs = 20'000'000;
const Eigen::Quaterniond kCameraFromImu(-0.5, 0.5, -0.5, 0.5);

tf2_msgs::msg::TFMessage tree_of(const std::string& parent, const std::string& child, std::int64_t stamp_ns,
                                 const geometry::Pose& parent_from_child) {
  geometry_msgs::msg::TransformStamped transform;
  transform.header(messages::make_header(stamp_ns, parent));
  transform.child_frame_id(child);
  transform.transform(messages::to_transform_message(parent_from_child));
  tf2_msgs::msg::TFMessage tree;
  tree.transforms().push_back(transform);
  return tree;
}

std::int64_t end_of_recording_ns() { return TrackerWithDriver::frames().back().stamp_ns + 100'000'000; }

class GyroscopeInput : public ::testing::Test {
 protected:
  GyroscopeInput() {
    static_ = driver_.bus().advertise<tf2_msgs::msg::TFMessage>("/tf_static", bus::kLatched);
    tf_ = driver_.bus().advertise<tf2_msgs::msg::TFMessage>("/tf", {.reliable = true, .depth = 2000});
    imu_ = driver_.bus().advertise<sensor_msgs::msg::Imu>("imu", {.reliable = true, .depth = 2000});
  }

  void publish_mounting(const Eigen::Quaterniond& camera_from_imu) {
    static_.write(tree_of(kOptical, "imu_link", 0, geometry::make_pose({0.01, 0, 0}, camera_from_imu)));
  }
  /// The camera moves on the robot as the recording's has moved, where the robot's IMU stays.
  void publish_mast() {
    const auto truth = TrackerWithDriver::truth();
    const std::int64_t end_ns = end_of_recording_ns();
    for (std::int64_t ns = TrackerWithDriver::frames().front().stamp_ns - kMastNs; ns < end_ns; ns += kMastNs)
      tf_.write(tree_of("imu_link", kOptical, ns, geometry::interpolate(truth, ns)));
  }
  /// What a gyroscope that stands as kCameraFromImu says tells of the recording, then the recording.
  /// @param more  that it also tells [rad/s].
  void track_with_imu(const Eigen::Vector3d& more = Eigen::Vector3d::Zero()) {
    track_with_rates([&](const Eigen::Vector3d& of_camera) {
      return Eigen::Vector3d(kCameraFromImu.conjugate() * of_camera + more);
    });
  }
  /// @param told_of  what the unit tells of the camera's turn rate [rad/s].
  void track_with_rates(const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& told_of) {
    const auto truth = TrackerWithDriver::truth();
    const std::int64_t end_ns = end_of_recording_ns();
    for (const auto& rate : simulator::gyroscope(truth, {.rate_hz = 100, .delay_ns = 0}, 1)) {
      if (rate.stamp_ns > end_ns) break;
      const Eigen::Vector3d in_imu = told_of(rate.rad_per_s);
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
  bus::Publisher<tf2_msgs::msg::TFMessage> tf_;
  bus::Publisher<sensor_msgs::msg::Imu> imu_;
  ToldDiagnostics told{driver_.bus()};
};

TEST_F(GyroscopeInput, IsRightWhereTfSaysHowItIsMounted) {
  publish_mounting(kCameraFromImu);
  track_with_imu();
  EXPECT_GT(std::atoi(told("imu messages").c_str()), 100) << driver_.log();
  EXPECT_EQ(told("gyroscope windows refused"), "0");
}

TEST_F(GyroscopeInput, IsRightOnABaseThatStandsUnderACameraThatATurningMastCarries) {
  publish_mast();
  track_with_rates([](const Eigen::Vector3d&) { return Eigen::Vector3d(Eigen::Vector3d::Zero()); });
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
