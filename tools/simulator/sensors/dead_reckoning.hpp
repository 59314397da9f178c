// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/trajectory.hpp"

namespace rds::simulator {

/// How odometry goes wrong: the stand-in for a robot's wheels.
struct DeadReckoningErrors {
  double scale = 1.05;            // of what is told to what is true, of way and turning
  double way_noise = 0.005;       // standard deviation after a metre; grows with its root
  double turn_noise_rad = 0.005;  // after a metre or a radian; likewise
  double slips_per_second = 0.25;
  double slip_s = 0.2;  // that each of them lasts
  double slip = 0.3;    // what is told then is so much more
};

/// What dead reckoning tells of a path: for each of its poses where the camera would be, in a frame of its
/// own that the first camera is the origin of.
///
/// @param truth  world_from_camera, ascending in time. @param seed  the same path, errors and seed: the same
/// result.
/// @return odom_from_camera, with the truth's stamps.
std::vector<geometry::StampedPose> dead_reckoning(std::span<const geometry::StampedPose> truth,
                                                  const DeadReckoningErrors& errors, std::uint64_t seed);

}  // namespace rds::simulator
