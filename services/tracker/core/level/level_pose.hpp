// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "common/geometry/pose.hpp"

namespace rds::tracker {

/// map_from_camera of the camera that a level map begins with (REP 103): the map's origin is the camera, z
/// points up, x ahead, as the camera looks, laid level; if it looks straight up or down, as its upper edge
/// points.
/// @param up_in_camera  unit vector.
geometry::Pose level_pose(const Eigen::Vector3d& up_in_camera);

}  // namespace rds::tracker
