// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/pose.hpp"

namespace rds::geometry {

/// Where a camera stood in one frame, and where it stands in another: how what it saw goes from the one to
/// the other.
struct PoseChange {
  Pose before_from_camera = Pose::Identity();
  Pose after_from_camera = Pose::Identity();

  [[nodiscard]] Pose after_from_before() const { return after_from_camera * before_from_camera.inverse(); }
};

}  // namespace rds::geometry
