// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <Eigen/Core>

#include "common/geometry/pose.hpp"

namespace rds::geometry {

struct RigidAlignment {
  Pose target_from_source = Pose::Identity();
  double similarity_scale = 1;  // what a similarity fit would have chosen; never applied
};

/// The rigid transform, without scale, that minimises Σ |target_i − target_from_source · source_i|².
///
/// @param source, target  N ≥ 1 points each [m]; point i of one belongs to point i of the other.
/// @throws std::invalid_argument if the counts differ or are 0.
/// Source: Umeyama 1991, eqs. 40–43, with scale 1 (Horn's problem). Deviation: none.
RigidAlignment align_rigid(std::span<const Eigen::Vector3d> source, std::span<const Eigen::Vector3d> target);

/// The rigid transform whose rotation minimises Σ ‖R_target − R · R_source‖² (Frobenius), and which lays the
/// positions' means on each other. Where a camera hardly leaves its place, its positions leave the rotation
/// open, its orientations do not.
///
/// @return target_from_source. @throws std::invalid_argument if the counts differ or are 0.
/// Source: Hartley et al. 2013, Rotation Averaging, §5.3 (chordal mean).
Pose align_orientations(std::span<const Pose> source, std::span<const Pose> target);

}  // namespace rds::geometry
