// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <vector>

#include "services/tracker/core/loops/loop_fusion.hpp"
#include "services/tracker/core/relocalization/found_keyframe.hpp"

namespace rds::tracker {

/// Sightings that have to agree on how two submaps lie to each other.
inline constexpr std::size_t kAgreeingSightings = 3;
/// Whether two poses of a keyframe are one, as far as sightings tell.
bool are_one(const Pose& a, const Pose& b);
/// Whether both sightings are of the same two submaps, and place the keyframe of the first alike.
bool agree(const SlamMap& map, const LoopMatch& newest, const LoopMatch& before);

/// Where keyframes of one submap were found in another one. One picture can deceive; three of the newest six
/// sightings that place the submaps alike do not.
/// Source: Mur-Artal & Tardós 2017 (consecutive detections); Campos et al. 2021, §VI-A.
class SubmapSightings {
 public:
  /// @param seen  the newest keyframe of the map, as the later one, and one of another submap that shows the
  /// same place.
  /// @return the sightings that agree with it, this one last; nothing while they are too few.
  std::vector<FoundKeyframe> add(const SlamMap& map, const FoundKeyframe& seen);
  void clear() { seen_.clear(); }

 private:
  std::deque<FoundKeyframe> seen_;  // oldest first
};

/// A submap moves into an older one.
struct SubmapMove {
  SubmapId moved = 0;
  SubmapId into = 0;
  Pose into_from_moved = Pose::Identity();
};

/// Whether the map confirms sightings that agree: confirms() of those by features, or, of kAgreeingSightings
/// by votes, that the camera can have walked there while it was lost (LoopDrift::log_odds()).
bool are_confirmed(const SlamMap& map, std::span<const FoundKeyframe> sightings);

/// What a sighting says: the younger of its two submaps goes to its place in the older one.
SubmapMove move_of(const SlamMap& map, const LoopMatch& seen);
/// Moves keyframes and points, and makes them the older submap's.
void move_submap(SlamMap& map, const SubmapMove& move);

}  // namespace rds::tracker
