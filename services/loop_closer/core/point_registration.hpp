// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/pose.hpp"
#include "services/loop_closer/core/loop_closer_config.hpp"

namespace rds::loop_closer {

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
/// config.max_ray_error, the inverse depths within config.max_inverse_depth_error (depth noise grows with
/// z²).
[[nodiscard]] bool agree(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const VerificationConfig& config);

/// Rigid transform that most pairs agree with, by RANSAC over three pairs (fixed seed), refined on its
/// inliers.
///
/// @return nullopt if no transform has config.min_ransac_inliers inliers.
/// Source: Umeyama 1991 without scale (minimal solution).
[[nodiscard]] std::optional<Registration> register_points(std::span<const PointPair> pairs,
                                                          const VerificationConfig& config);

/// Refines `candidate_from_query` on the pairs it agrees with (Gauss–Newton, Huber) and returns those that
/// agree then.
[[nodiscard]] Registration refine_registration(std::span<const PointPair> pairs,
                                               const geometry::Pose& candidate_from_query,
                                               const VerificationConfig& config);

}  // namespace rds::loop_closer
