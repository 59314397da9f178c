// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/pose.hpp"
#include "services/tracker/core/features/image_pyramid.hpp"

namespace rds::tracker {

/// Levels that the pictures' pyramids need, the coarsest of which is aligned first.
inline constexpr int kAlignmentLevels = 5;

/// A point and where the reference picture shows it.
struct SeenPoint {
  Eigen::Vector2f image_px = Eigen::Vector2f::Zero();      // in the reference picture
  Eigen::Vector3d in_reference = Eigen::Vector3d::Zero();  // m, z > 0, in the reference camera's frame
};

/// Moves the camera so that the picture looks around the points as the reference picture does.
///
/// Gauss–Newton on SE(3) over 4×4 pixels per point, from coarse to fine levels, inverse compositional, with
/// one offset of brightness. Residuals are of Student's t with five degrees of freedom, at the scale that is
/// most likely: what hides some points does not count against many that fit, however little contrast they
/// have. Each level begins with the better of the coarser one's pose and the start. What stays apart is the
/// pixel that a point was seen at and the one it projects to in the reference (rolling shutter, noise): it is
/// taken over into the picture. Source: Forster, Pizzoli & Scaramuzza 2014 (SVO), §IV-A; Kerl, Sturm &
/// Cremers 2013, §III. Deviation: depth is measured, not filtered.
/// @return camera_from_reference; the start where too few points can be compared.
geometry::Pose align_sparsely(const ImagePyramid& reference, std::span<const SeenPoint> points,
                              const ImagePyramid& picture, const geometry::CameraModel& camera,
                              const geometry::Pose& start);

}  // namespace rds::tracker
