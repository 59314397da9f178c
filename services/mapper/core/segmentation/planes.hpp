// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "services/mapper/core/keyframe/keyframe_record.hpp"
#include "services/mapper/core/segmentation/plane_fit.hpp"

namespace rds::mapper {

/// A large flat surface of a keyframe: floor, wall, table top.
struct FlatSurface {
  Plane plane;                      // camera frame
  std::vector<std::size_t> pixels;  // indices of sampled pixels, ascending
};

/// Share of the picture that a plane fills at least: 10 000 px of 640×480.
inline constexpr double kMinPlaneShare = 0.033;

/// True for a point in the camera's frame that is measured as well as on the plane.
inline bool lies_on(const Plane& plane, const Eigen::Vector3f& point, const geometry::DepthNoise& noise) {
  return std::abs(plane.distance_m(point.cast<double>())) < noise.plane_tolerance_m(double{point.z()});
}

/// Splits the picture into square cells, fits planes to their points, and joins the cells that deviate from a
/// common plane no more than depth is noisy: neighbours first, then all others wherever they are, such as the
/// parts of a wall between people.
///
/// Sums over cells bear with a depth picture that is noisy and lacks single pixels; integral-image normals
/// need places without either.
/// @return surfaces of at least kMinPlaneShare of the picture, the largest first; pixels that are not
/// kStatic take no part. Source: Proença & Gao 2018 (CAPE), §III. Deviation: cells are compared with the
/// plane, not by their normals.
std::vector<FlatSurface> find_planes(const KeyframeRecord& record, const geometry::DepthNoise& noise);

}  // namespace rds::mapper
