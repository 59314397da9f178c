// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/image/recording.hpp"

namespace rds::play {

/// What of a robot's sensors is to be played beside a recording's pictures.
struct SensorChoice {
  bool imu = false;
  bool odometry = false;
  std::filesystem::path odometry_file = {};  // TUM trajectory of the camera, in place of the recording's
};

/// @throws std::runtime_error with one sentence if the recording has not what is asked for, or the file
/// cannot be read or tells of no pose.
image::RobotSensors chosen_sensors(const image::Recording& recording, const SensorChoice& choice);

}  // namespace rds::play
