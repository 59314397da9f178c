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

}  // namespace rds::geometry
