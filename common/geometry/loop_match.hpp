// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/geometry/pose.hpp"

namespace rds::geometry {

/// Two keyframes that show the same place, and how they stand to each other as measured from what both see.
struct LoopMatch {
  std::uint64_t later = 0;
  std::uint64_t earlier = 0;
  Pose earlier_from_later = Pose::Identity();
};

}  // namespace rds::geometry
