// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

namespace rds::tracker {

/// Which way is up in a picture.
struct UpDirection {
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();  // unit vector in the camera frame
  double level = 0;                                // share of the surfaces that are level: floors, tables
  double upright = 0;                              // share of those that are upright: walls, cupboards
  int surfaces = 0;

  /// True if surfaces say so: level ones, or upright ones of at least two directions. Else `up` is a guess.
  bool is_seen = false;
};

/// The most probable direction against gravity, given the normals of what a camera sees that somebody holds
/// or has mounted more or less upright.
///
/// A normal n is drawn from a mixture: level surfaces (a Gaussian of 3° about ±up), upright ones (a Gaussian
/// of 3° about the great circle that is perpendicular to up), and any other (uniform). As few directions are
/// within 3° of a given one, level surfaces say much more than upright ones. The camera's tilt has a Gaussian
/// of 25° as its prior, at most 60°. The maximum is looked for among the normals, their cross products
/// and what is perpendicular to them, and refined by expectation and maximisation.
/// @param normals  unit vectors in the camera frame, of either sign.
UpDirection find_up(std::span<const Eigen::Vector3d> normals);

}  // namespace rds::tracker
