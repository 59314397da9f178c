// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/oriented_box.hpp"
#include "services/tracker/core/prediction/tracked_object.hpp"

namespace rds::tracker::prediction {

/// Where a detection's box ends within `border_px` of the picture's edge.
CutSides cut_sides(const geometry::OrientedBox& box, const geometry::Pose& camera_from_map,
                   const geometry::CameraModel& camera, double border_px);

/// The box with its sides moved outwards by a share of its width and height, clipped to the picture: a
/// network's boxes end before outstretched arms and legs do.
geometry::Box2 with_reach(const geometry::Box2& box, double share, const geometry::CameraModel& camera);

/// Share by which a movable object is shown larger.
inline constexpr double kReachShare = 0.08;

/// Margins of a region: on each side of its box, and at each end of its interval of depths.
inline constexpr double kRegionMarginPx = 4;
inline constexpr double kRegionMarginM = 0.1;

/// image_box() and the region of the features to drop: the box with its margin, and the depths
/// centre ± (half the thickness + margin).
std::optional<PredictedBox> to_image(const geometry::OrientedBox& box, const geometry::Pose& camera_from_map,
                                     const geometry::CameraModel& camera);

}  // namespace rds::tracker::prediction
