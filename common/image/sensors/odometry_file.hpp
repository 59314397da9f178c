// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "common/image/sensors/robot_sensors.hpp"

namespace rds::image {

/// Reads a TUM trajectory of the camera, in a frame of its own, as a robot's odometry.
/// @return or one sentence that names file, line and expectation; there is at least one pose.
tl::expected<OdometryTrack, std::string> read_odometry(const std::filesystem::path& file);

}  // namespace rds::image
