// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/play/sensor_choice.hpp"

#include <stdexcept>

#include "common/image/sensors/odometry_file.hpp"

namespace rds::play {
namespace {

image::OdometryTrack read(const std::filesystem::path& file) {
  auto odometry = image::read_odometry(file);
  if (!odometry) throw std::runtime_error(odometry.error());
  return std::move(*odometry);
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
