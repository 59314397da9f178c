// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/geometry/pose.hpp"
#include "services/tracker/core/features/feature.hpp"

namespace rds::tracker {

/// A feature and where it stands in a level frame (z is up) [m].
struct PlacedFeature {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  const Descriptor* descriptor = nullptr;
};

/// Two features that look alike, by their indices.
struct AlikePair {
  std::size_t here = 0;
  std::size_t there = 0;
};

/// What is known of how two level frames lie to each other: a point of the one, and where it is in the other
/// within a radius over the ground.
struct VoteWindow {
  Eigen::Vector3d point_here = Eigen::Vector3d::Zero();
  Eigen::Vector3d point_there = Eigen::Vector3d::Zero();
  double radius_m = 1;
};

/// How two level frames may lie to each other, and the votes for it: features that stand by one that looks
/// like them.
struct VotedPose {
  geometry::Pose there_from_here = geometry::Pose::Identity();
  double votes = 0;
};

/// Pairs that look alike and stand at the same height.
std::vector<AlikePair> alike_pairs(std::span<const PlacedFeature> here, std::span<const PlacedFeature> there,
                                   const VoteWindow& window);

/// The poses that most features vote for, best first: each feature has one vote, which its pairs share, for
/// every turn about the vertical. Where patterns repeat and where what is seen again was seen from elsewhere,
/// too few features match for certain (the second best is as good) for a pose by these; all of them together
/// still tell the place.
/// Source: Ballard 1981, "Generalizing the Hough transform to detect arbitrary shapes".
std::vector<VotedPose> vote_for_poses(std::span<const PlacedFeature> here,
                                      std::span<const PlacedFeature> there, std::span<const AlikePair> pairs,
                                      const VoteWindow& window);

/// Lays features on those that look alike and stand nearest, closer and closer.
/// @return the features of there that are met, by index; fewer than 10: it could not be done.
std::vector<std::size_t> align_alike(std::span<const PlacedFeature> here,
                                     std::span<const PlacedFeature> there, std::span<const AlikePair> pairs,
                                     geometry::Pose& there_from_here);

}  // namespace rds::tracker
