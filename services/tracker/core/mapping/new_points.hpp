// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/mapping/mapping_scene.hpp"

namespace rds::tracker {

/// Keyframes that must see a point without depth before it enters the map.
inline constexpr std::size_t kMinTriangulatingViews = 3;

/// Makes points of the centre's features that have no depth and see no point.
///
/// A feature of a covisible keyframe that lies on the epipolar line and alone looks alike gives a first
/// position; the other keyframes are searched around where that projects. A point enters the result if three
/// views and more, and most of those that should show it, agree with it (χ² bound), its distances fit the
/// features' scales, and is_known_well(), by the covariance that triangulate() gives. Features on what is
/// movable take no part.
/// Source: Mur-Artal et al. 2015, §VI-D. Deviations: a third view; the covariance decides, not an angle.
void triangulate_points(const MappingScene& scene, LocalMappingResult& result);

/// True for a point that was made without depth, and that no keyframe has seen with depth since.
bool rests_on_views(const SlamMap& map, const MapPoint& point);

/// Erases such a point if the keyframes that still see it know it too badly: one was culled, or does not see
/// it any more.
void erase_if_unknown(SlamMap& map, PointId point);

}  // namespace rds::tracker
