// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "common/geometry/trajectory.hpp"

namespace rds::evaluation {

/// Keyframes that show a place again, by the truth: the camera is within 1 m and 30° of an earlier keyframe,
/// and was more than 2 m or 60° away from here in between.
struct ReturnScore {
  std::size_t returned = 0;
  std::size_t missed = 0;  // that stand wrong to the earlier one: more than 15 cm or 5° off

  [[nodiscard]] double missed_share() const {
    return returned > 0 ? static_cast<double>(missed) / static_cast<double>(returned) : 0;
  }
};

/// @param keyframes  with their final poses in any frame, ascending in time; those whose stamps the truth
/// does not reach are left out. @param truth  ascending in time.
ReturnScore score_returns(std::span<const geometry::StampedPose> keyframes,
                          std::span<const geometry::StampedPose> truth);

}  // namespace rds::evaluation
