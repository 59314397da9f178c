// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/camera_model.hpp"
#include "tools/rds/doctor/checks/finding.hpp"

namespace rds::doctor {

/// A lens and a sensor that can be: field of view 25° … 130°, square pixels, principal point near the middle.
Finding check_camera(const geometry::CameraModel& camera);

}  // namespace rds::doctor
