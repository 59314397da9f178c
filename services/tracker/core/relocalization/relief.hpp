// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

namespace rds::tracker {

/// The pattern of a wall repeats, and so do walls: a place is recognised by what does not lie in one plane.
/// Of a rendered building, 2 … 4 m away, walls have a relief of .001, what else is seen .1.
inline constexpr double kMinRelief = 0.05;

/// How far points stand off the plane that fits them best, a standard deviation, relative to their distance
/// from the camera; 0 of none.
double relief_of(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& camera);

}  // namespace rds::tracker
