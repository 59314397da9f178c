// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/pose.hpp"
#include "tools/simulator/world/scene.hpp"

namespace rds::simulator {

/// The rooms that may be in the picture, by ascending number: the one around the camera, and those that it
/// sees through a chain of openings. Furniture hides nothing.
///
/// @param camera  without distortion.
/// Source: Luebke & Georges, I3D 1995 (portals and their boxes in the picture).
std::vector<std::size_t> visible_rooms(const Scene& scene, const geometry::CameraModel& camera,
                                       const geometry::Pose& world_from_camera);

}  // namespace rds::simulator
