// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "services/tracker/core/pose/association.hpp"
#include "services/tracker/core/removal/movable_mask.hpp"

namespace rds::tracker {

/// Makes a frame a keyframe: its inlier map points are observed, new map points are made from its depth (all
/// close ones, at least the 400 nearest), covisibility is computed.
Keyframe& insert_keyframe(SlamMap& map, const TrackedFrame& frame, const DepthConfig& depth);

/// Erases recently made points that proved bad: seldom found where they should show, or seen by too few
/// keyframes two keyframes on. Points that pass leave the list.
///
/// @param recent  ids in order of making; those decided about are removed.
/// Source: Mur-Artal et al. 2015, §VI-B; the depth sensor makes two observers enough.
void cull_recent_points(SlamMap& map, KeyframeId newest, std::vector<PointId>& recent);

/// Removes keyframes around `newest` of whose close points most are seen by enough others at the same or a
/// finer scale. The first keyframe, the fixed ones and the last few always stay.
/// @return the removed ones. Source: Mur-Artal & Tardós 2017, §III-E.
std::vector<KeyframeId> cull_redundant_keyframes(SlamMap& map, KeyframeId newest, const DepthConfig& depth);

/// Late boxes: erases the points that this keyframe made of features in the regions, lets it forget older
/// points there, and never makes points of these features again. In their place it makes points of its other
/// features, as insert_keyframe() does: the nearest ones may all have been on people. Unknown keyframes are
/// ignored.
void retract_movable(SlamMap& map, KeyframeId keyframe, const MovableMask& movable, const DepthConfig& depth);

}  // namespace rds::tracker
