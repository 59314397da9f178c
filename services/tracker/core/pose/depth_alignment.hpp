// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/pose.hpp"
#include "services/tracker/core/removal/motion_evidence.hpp"

namespace rds::tracker {

/// What an earlier picture showed.
struct EarlierView {
  SeenCells standing;
  SeenCells movable;  // may have moved since, and counts little; the same pose
};

/// Where the camera is by depth alone: what an earlier picture saw is laid on the surfaces that this one
/// shows.
///
/// Point to plane, each point with the cell it shows up in (Newcombe et al. 2011, KinectFusion, §3.5),
/// robustly: what has moved disagrees.
/// @param depth_m  of the new picture, in the cells of `grid`.
/// @param guess    camera_from_map, to about 0.1 m and 5°.
/// @return camera_from_map; nullopt where too little of what was seen shows again, or its surfaces leave the
/// camera free to move in some direction, as a single wall does.
std::optional<geometry::Pose> align_depth(const EarlierView& before, const cv::Mat1f& depth_m,
                                          const GridGeometry& grid, const geometry::Pose& guess);

}  // namespace rds::tracker
