// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "common/image/sensors/robot_sensors.hpp"

namespace rds::image {

/// Reads what an inertial measurement unit has told, in the axes of the camera's optical frame:
/// `timestamp ax ay az wx wy wz` per line [s, m/s², rad/s], `#` comments; without the last three numbers, on
/// all lines, there is no gyroscope. Of lines with one stamp the first counts.
///
/// @return or one sentence that names file, line and expectation; stamps never decrease.
tl::expected<ImuTrack, std::string> read_imu(const std::filesystem::path& file);

/// What read_imu() reads, as text: turned into the camera's axes. Where the unit is on the camera gets lost.
std::string imu_lines(const ImuTrack& track);

}  // namespace rds::image
