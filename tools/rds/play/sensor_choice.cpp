// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/play/sensor_choice.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace rds::play {
namespace {

image::OdometryTrack read(const std::filesystem::path& file) {
  auto poses = geometry::read_trajectory(file);
  if (!poses) throw std::runtime_error(poses.error());
  if (poses->empty()) throw std::runtime_error(fmt::format("{}: expected at least one pose", file.string()));
  return {.odom_from_body = std::move(*poses)};
}

}  // namespace

image::RobotSensors chosen_sensors(const image::Recording& recording, const SensorChoice& choice) {
  image::RobotSensors chosen;
  if (choice.imu) chosen.imu = recording.sensors().imu;
  if (choice.imu && !chosen.imu)
    throw std::runtime_error(
        "--imu: expected a recording with an IMU, imu.txt or a topic of sensor_msgs/msg/Imu that tf joins "
        "with the camera");
  if (!choice.odometry_file.empty())
    chosen.odometry = read(choice.odometry_file);
  else if (choice.odometry)
    chosen.odometry = recording.sensors().odometry;
  if (choice.odometry && !chosen.odometry)
    throw std::runtime_error(
        "--odometry: expected a recording with odometry, odometry.txt or a topic of nav_msgs/msg/Odometry "
        "that tf joins with the camera");
  return chosen;
}

}  // namespace rds::play
