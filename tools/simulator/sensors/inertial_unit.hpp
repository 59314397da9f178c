// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "common/geometry/trajectory.hpp"
#include "common/image/sensors/robot_sensors.hpp"
#include "tools/simulator/sensors/gyroscope.hpp"

namespace rds::simulator {

/// How a unit of gyroscope and accelerometer errs; the defaults are those of a consumer's chip (Bosch BMI055
/// data sheet), with the accelerometer's offset as it is after a calibration.
struct InertialErrors {
  GyroscopeErrors gyroscope = {};
  double noise = 1.5e-3;        // of acceleration, m/s²/√Hz: 150 µg/√Hz
  double bias_m_per_s2 = 0.05;  // standard deviation of each axis
};

/// What an inertial measurement unit tells that stands where the camera does, in its axes.
///
/// @param truth  world_from_camera with z up, ascending in time and at least twice as dense as the unit's
/// rate; it tells of all but the ends. @param seed  the same path, errors and seed: the same result.
image::ImuTrack inertial_unit(std::span<const geometry::StampedPose> truth, const InertialErrors& errors,
                              std::uint64_t seed);

}  // namespace rds::simulator
