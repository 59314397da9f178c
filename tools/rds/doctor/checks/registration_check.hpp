// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/geometry/camera_model.hpp"
#include "tools/rds/doctor/checks/finding.hpp"
#include "tools/rds/doctor/registration/depth_registration.hpp"

namespace rds::doctor {

/// Does depth lie on colour? Says where it fits best otherwise, and what colour's focal length would then be
/// if camera.yaml holds the depth camera's.
///
/// @param fit  nullopt: nothing could be told.
Finding check_registration(const std::optional<RegistrationFit>& fit, const geometry::CameraModel& camera);

}  // namespace rds::doctor
