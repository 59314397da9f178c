// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>

#include "common/geometry/loop_match.hpp"
#include "services/tracker/core/map/slam_map.hpp"

namespace rds::tracker {

using geometry::LoopMatch;

/// Points that are gone, each with the one that took its place.
using ReplacedPoints = std::map<PointId, PointId>;

/// Whether the map confirms that these keyframes show one place.
///
/// Points of an earlier keyframe and its neighbours are searched in the later one, placed as was measured,
/// and must agree with its features in position and depth. Then how the points of all matches look there, and
/// how far the map would have drifted, are weighed together: the sum of their log-odds must not be negative.
/// True, too, where two keyframes share points already.
bool confirms(const SlamMap& map, std::span<const LoopMatch> loops);
/// The same of two maps that are merged: no camera went from one to the other, so looks alone decide.
bool confirms_of_merged_maps(const SlamMap& map, const LoopMatch& loop);

/// Joins the two sides of a loop: what both see becomes one point, and their keyframes covisible.
///
/// The points that confirm the loop say how the two sides stand to each other, however far apart they are in
/// the map. Then points of either side are searched in the keyframes of the other; they are one where
/// position and depth agree within the χ² bound. Poses and positions stay as they are.
/// @return the points that were replaced; nullopt if the map does not confirm the loop, or shares points
/// there already: then nothing has changed.
/// Source: Mur-Artal et al. 2015, §VII-C. Deviation: the sides' alignment comes from the map's points.
std::optional<ReplacedPoints> join_loop(SlamMap& map, const LoopMatch& loop);

}  // namespace rds::tracker
