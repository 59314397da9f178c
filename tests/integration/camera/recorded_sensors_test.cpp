// SPDX-License-Identifier: Apache-2.0
// Whole runs of the real processes on a bag of a robot: an IMU and odometry of its base beside the pictures,
// and how both stand to the camera. Each frame has the measurements up to its time, whatever the bus.
#include <numbers>

#include <gmock/gmock.h>

#include "common/image/tum_dataset.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/bus/vendors.hpp"
#include "tests/support/disturbed_dataset.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/recording/conversion.hpp"
#include "tools/simulator/sensors/dead_reckoning.hpp"
#include "tools/simulator/sensors/gyroscope.hpp"

namespace rds::test {
namespace {

using geometry::Pose;
using geometry::StampedPose;
using testing::HasSubstr;
using testing::Not;

constexpr std::size_t kFrames = 250;
constexpr FrameRange kCovered{.first = 190, .count = 50};
constexpr double kMaxErrorM = 0.03;
constexpr std::int64_t kStandingNs = 600'000'000;  // before the first picture
constexpr std::int64_t kStepNs = 10'000'000;
// An accelerometer that tells another way than the picture shows: the map can have it from there alone.
const Eigen::Vector3d kUpInCamera = Eigen::Vector3d(1, -1, 0).normalized();
const Pose kCameraFromImu = geometry::make_pose({0.02, 0, 0}, Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5));
const Pose kBodyFromCamera = geometry::make_pose({0.2, 0.1, 0.4}, Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5));

/// A recording's pictures, and what a robot would have sensed meanwhile.
class RobotRecording final : public image::Recording {
 public:
  explicit RobotRecording(const image::TumDataset& pictures) : Recording(pictures), pictures_(pictures) {
    sensors_.imu = image::ImuTrack{.camera_from_imu = kCameraFromImu};
    add_standing();
    const auto& truth = ground_truth_.value();
    for (const auto& rate : simulator::gyroscope(truth, {.rate_hz = 100, .delay_ns = 0}, 1))
      if (rate.stamp_ns > frames().front().stamp_ns)
        add_measurement(rate.stamp_ns, Eigen::Vector3d::Zero(), rate.rad_per_s);
    sensors_.odometry = image::OdometryTrack{.body_from_camera = kBodyFromCamera};
    for (const StampedPose& pose : simulator::dead_reckoning(truth, {.slips_per_second = 0}, 1))
      sensors_.odometry->odom_from_body.push_back(
          {pose.stamp_ns, pose.map_from_camera * kBodyFromCamera.inverse(), ""});
  }
  [[nodiscard]] tl::expected<image::ColorImage, std::string> load_color(std::size_t index) const override {
    return pictures_.load_color(index);
  }
  [[nodiscard]] tl::expected<image::DepthImage, std::string> load_depth(std::size_t index) const override {
    return pictures_.load_depth(index);
  }

 private:
  void add_standing() {
    const std::int64_t first_ns = frames().front().stamp_ns;
    for (std::int64_t ns = first_ns - kStandingNs; ns <= first_ns; ns += kStepNs)
      add_measurement(ns, 9.81 * kUpInCamera, Eigen::Vector3d::Zero());
  }
  void add_measurement(std::int64_t stamp_ns, const Eigen::Vector3d& acceleration,
                       const Eigen::Vector3d& rate) {
    const Eigen::Matrix3d imu_from_camera = kCameraFromImu.linear().transpose();
    sensors_.imu->measurements.push_back({stamp_ns, imu_from_camera * acceleration, imu_from_camera * rate});
  }

  const image::TumDataset& pictures_;
};

class RecordedSensors : public testing::Test {
 protected:
  RecordedSensors() {
    make_excerpt(rendered_recording("room_empty"), place / "whole", kFrames);
    make_blacked_out(place / "whole", place / "covered", kCovered, Darkened::kColorAndDepth);
    const auto pictures = image::TumDataset::open(place / "covered").value();
    auto writer = recording::make_bag_writer(place / "robot.mcap", mcap::Compression::kLz4).value();
    const auto written = recording::write_bag(RobotRecording(pictures), *writer);
    if (!written) throw std::runtime_error(written.error());
    truth = pictures.ground_truth().value();
  }
  ProcessResult run_on(const std::string& dataset, const std::string& out,
                       std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--no-dynamics", "--frame", "map"});
    return run(place / dataset, place / out, arguments);
  }
  [[nodiscard]] std::vector<StampedPose> trajectory(const std::string& out) const {
    return geometry::read_trajectory(place / out / "trajectory.txt").value();
  }
  [[nodiscard]] std::string tracker_log(const std::string& out) const {
    return read_text(place / out / "log/rds-tracker.log");
  }
  /// Between what the accelerometer says and the map's z.
  [[nodiscard]] double tilt_deg(const std::string& out) const {
    const Eigen::Vector3d up = trajectory(out).front().map_from_camera.linear() * kUpInCamera;
    return std::acos(std::min(up.z(), 1.0)) * 180 / std::numbers::pi;
  }
  /// Of the motion since the frame before the lens was covered, the largest that was carried on.
  [[nodiscard]] double carried_error_m(const std::string& out) const {
    const auto live = trajectory(out);
    const auto& before = live.at(kCovered.first - 1);
    const Pose true_before = geometry::interpolate(truth, before.stamp_ns);
    double largest_m = 0;
    for (std::size_t i = kCovered.first; i < kCovered.first + kCovered.count; ++i) {
      const Pose told = before.map_from_camera.inverse() * live.at(i).map_from_camera;
      const Pose expected = true_before.inverse() * geometry::interpolate(truth, live.at(i).stamp_ns);
      largest_m = std::max(largest_m, (told.translation() - expected.translation()).norm());
    }
    return largest_m;
  }
  void expect_same(const std::string& a, const std::string& b) const {
    for (const char* file : {"trajectory.txt", "keyframes.txt", "map.ot"})
      EXPECT_EQ(read_text(place / a / file), read_text(place / b / file)) << file;
  }

  TemporaryFolder place;
  std::vector<StampedPose> truth;
};

TEST_F(RecordedSensors, OfABagServeTheTrackerTheSameOnEachBus) {
  for (const std::string& bus : all_vendor_names()) {
    const auto result = run_on("robot.mcap", bus, {"--rate", "max", "--imu", "--odometry", "--bus", bus});
    ASSERT_EQ(result.status, 0) << result.standard_error;
    EXPECT_THAT(result.standard_error, HasSubstr("IMU /imu"));
    EXPECT_THAT(tracker_log(bus), Not(HasSubstr("has come on"))) << "a frame has waited in vain";
  }
  EXPECT_LT(tilt_deg("fastdds"), 0.1);
  ASSERT_EQ(trajectory("fastdds").size(), kFrames) << "odometry carries the covered camera on";
  EXPECT_LE(carried_error_m("fastdds"), kMaxErrorM);
  for (const std::string& bus : all_vendor_names()) expect_same("fastdds", bus);
}

TEST_F(RecordedSensors, ArePlayedAtTheRecordedSpeedToo) {
  const auto result = run_on("robot.mcap", "live", {"--imu", "--odometry", "--frames", "60"});
  ASSERT_EQ(result.status, 0) << result.standard_error;
  EXPECT_LT(tilt_deg("live"), 0.1);
}

TEST_F(RecordedSensors, AreNotUsedUnlessAskedForAndMustBeThere) {
  ASSERT_EQ(run_on("robot.mcap", "without", {"--rate", "max", "--frames", "30"}).status, 0);
  EXPECT_GT(tilt_deg("without"), 30) << "by the picture";
  const auto result = run_on("covered", "none", {"--imu"});
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.standard_error, HasSubstr("--imu: expected a recording with an IMU"));
}

}  // namespace
}  // namespace rds::test
