// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/tracker/core/mapping/mapping_scene.hpp"

namespace rds::tracker {

/// Makes points of the centre's features that have no depth and see no point.
///
/// A feature of a covisible keyframe that lies on the epipolar line and alone looks alike gives a first
/// position; the other keyframes are searched around where that projects. A point enters the result if three
/// views and more, and most of those that should show it, agree with it (χ² bound), its distances fit the
/// features' scales, and is_known_well(), by the covariance that triangulate() gives. Features on what is
/// movable take no part.
/// Source: Mur-Artal et al. 2015, §VI-D. Deviations: a third view; the covariance decides, not an angle.
void triangulate_points(const MappingScene& scene, LocalMappingResult& result);

}  // namespace rds::tracker
