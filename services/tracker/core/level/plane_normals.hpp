// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Core>

#include "services/tracker/core/pose/depth_aligner.hpp"

namespace rds::tracker {

/// Normals (unit vectors in the camera frame, away from the camera) of the planar parts of a picture: of each
/// window of cells, half a window apart, whose depth is a plane's to within the sensor's noise.
///
/// Of a plane n·p = d, the inverse depth is linear in the ray (x, y, 1): 1/z = n·(x, y, 1)/d, and the noise
/// of a camera that triangulates, which grows with z², is the same everywhere in 1/z: σ_z / z². (Of another
/// camera it is nearly so within a window.) So a window is fitted by ordinary least squares.
std::vector<Eigen::Vector3d> plane_normals(const DepthView& view);

}  // namespace rds::tracker
