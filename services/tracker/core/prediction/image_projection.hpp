// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/oriented_box.hpp"
#include "services/tracker/core/prediction/prediction_config.hpp"
#include "services/tracker/core/prediction/tracked_object.hpp"

namespace rds::tracker::prediction {

/// Image box of a box that was made from a detection.
///
/// The rectangle size.x × size.y through the box's centre is turned to face the camera; its top-left and
/// bottom-right corners (the paper's P_wp1 and P_wp2) are projected with distortion. At the pose of the
/// detection this is the detection's box, whatever the thickness: the hull of the eight corners would be
/// wider. A camera that has rolled about its axis by θ since sees the half extents √((w cos θ)² + (h sin θ)²)
/// and √((w sin θ)² + (h cos θ)²): those of the ellipse in the rectangle, because people do not fill its
/// corners.
///
/// @return with the parts outside the picture; nullopt if the centre is not in front of the camera.
/// Source: paper §IV-B, eq. (1), P_c = T_cw · P_wp.
std::optional<geometry::Box2> whole_image_box(const geometry::OrientedBox& box,
                                              const geometry::Pose& camera_from_map,
                                              const geometry::CameraModel& camera);

/// whole_image_box() clipped to the picture; nullopt if nothing of it is there.
std::optional<geometry::Box2> image_box(const geometry::OrientedBox& box,
                                        const geometry::Pose& camera_from_map,
                                        const geometry::CameraModel& camera);

/// Where a detection's box ends within `border_px` of the picture's edge.
CutSides cut_sides(const geometry::OrientedBox& box, const geometry::Pose& camera_from_map,
                   const geometry::CameraModel& camera, double border_px);

/// image_box() and the region of the features to drop: the box with its margin, and the depths
/// centre ± (half the thickness + margin).
std::optional<PredictedBox> to_image(const geometry::OrientedBox& box, const geometry::Pose& camera_from_map,
                                     const geometry::CameraModel& camera, const RegionConfig& config = {});

std::optional<PredictedBox> to_image(const PredictedObject& object, const geometry::Pose& camera_from_map,
                                     const geometry::CameraModel& camera, const RegionConfig& config = {});

}  // namespace rds::tracker::prediction
