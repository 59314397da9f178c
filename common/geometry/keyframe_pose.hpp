// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/geometry/pose.hpp"

namespace rds::geometry {

/// Where a keyframe's camera stands.
struct KeyframePose {
  std::uint64_t id = 0;
  std::int64_t stamp_ns = 0;
  Pose map_from_camera = Pose::Identity();
};

}  // namespace rds::geometry
