// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/image/recording.hpp"
#include "tools/rds/doctor/checks/finding.hpp"

namespace rds::doctor {

/// A sensor's measurements, and for how many frames there is one before and one after, no further apart than
/// the tracker interpolates.
/// @param frames, measurements  stamps [ns], ascending.
Finding check_sensor(const std::string& subject, std::span<const std::int64_t> frames,
                     std::span<const std::int64_t> measurements, std::int64_t max_gap_ns);

/// Odometry and IMU, as far as the recording has them.
std::vector<Finding> check_sensors(const image::Recording& recording);

}  // namespace rds::doctor
