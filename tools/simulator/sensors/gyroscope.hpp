// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/trajectory.hpp"

namespace rds::simulator {

/// How a gyroscope errs; the defaults are those of a consumer's chip (Bosch BMI055 data sheet).
struct GyroscopeErrors {
  double rate_hz = 200;
  double noise = 2.4e-4;              // rad/s/√Hz: 0.014 °/s/√Hz
  double bias_rad_per_s = 0.017;      // standard deviation of each axis at the start: 1 °/s
  double bias_walk = 2e-5;            // rad/s²/√Hz
  double scale = 0.01;                // standard deviation of each axis
  std::int64_t delay_ns = 3'000'000;  // of its stamps to the camera's
};

struct TurnRate {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d rad_per_s = Eigen::Vector3d::Zero();  // in the camera's frame
};

/// What a gyroscope on the camera tells of a path: mean rates between its samples.
///
/// @param truth  world_from_camera, ascending in time. @param seed  the same path, errors and seed: the same
/// result.
std::vector<TurnRate> gyroscope(std::span<const geometry::StampedPose> truth, const GyroscopeErrors& errors,
                                std::uint64_t seed);

}  // namespace rds::simulator
