// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "common/geometry/oriented_box.hpp"

namespace rds::mapper {

/// A box with two level faces.
struct UprightBox {
  geometry::OrientedBox box;  // its z axis is the direction up, its x axis along the longer level edge
  double yaw_rad = 0;         // of that edge about up, from the level frame's x axis; in (−π/2, π/2]
};

/// The upright box around points, as they lie in the map [m].
///
/// Seen from above it is the rectangle of least area that has, across each of its two directions, the points
/// between the 2nd and the 98th percentile in it; of equal ones that nearest to the level frame's axes. Its
/// height is between the same percentiles. An edge is at least `thinnest_m` long.
/// Source: Freeman & Shapira 1975, minimum-area enclosing rectangle. Deviation: percentiles, because a few
/// voxels beside an object bear its label; so it is found by search over the angle, to 1°.
/// @param points  at least one. @param map_from_level  rotation; the third column is the direction up.
UprightBox upright_box(std::span<const Eigen::Vector3d> points, const Eigen::Matrix3d& map_from_level,
                       double thinnest_m);

}  // namespace rds::mapper
