// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose.hpp"

namespace rds::loop_closer {

// How far two measurements of one point may differ. The noise of an RGB-D camera is constant in the picture
// and, since depth comes from disparity, in inverse depth (Khoshelham & Elberink 2012).
inline constexpr double kMaxRayError = 0.008;          // in x/z and y/z; 4 px at f = 525 px
inline constexpr double kMaxInverseDepthError = 0.05;  // [1/m]; 5 cm at 1 m, 20 cm at 2 m

/// One physical point, seen by two cameras [m, camera frames, z > 0].
struct PointPair {
  Eigen::Vector3d in_query;
  Eigen::Vector3d in_candidate;
};

struct Registration {
  geometry::Pose candidate_from_query = geometry::Pose::Identity();
  std::vector<int> inliers;  // ascending indices into the pairs
};

/// True if the two points are one within what an RGB-D camera measures: the rays (x/z, y/z) within
/// kMaxRayError, the inverse depths within kMaxInverseDepthError.
[[nodiscard]] bool agree(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Rigid transform that most pairs agree with, by RANSAC over three pairs (fixed seed), refined on its
/// inliers.
///
/// @return nullopt if no transform has 20 inliers.
/// Source: Umeyama 1991 without scale (minimal solution).
[[nodiscard]] std::optional<Registration> register_points(std::span<const PointPair> pairs);

/// Refines `candidate_from_query` on the pairs it agrees with (Gauss–Newton, Huber) and returns those that
/// agree then.
[[nodiscard]] Registration refine_registration(std::span<const PointPair> pairs,
                                               const geometry::Pose& candidate_from_query);

}  // namespace rds::loop_closer
