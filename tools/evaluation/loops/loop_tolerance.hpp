// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/geometry/pose.hpp"

namespace rds::evaluation {

constexpr std::int64_t kMaxTruthGapNs = 100'000'000;  // between two true poses

inline bool is_within(const geometry::Pose& a_from_b, double max_m, double max_rad) {
  return a_from_b.translation().norm() <= max_m && geometry::rotation_angle_rad(a_from_b.linear()) <= max_rad;
}

/// How a loop's two keyframes stand to each other: of what a right match measures the error is a few
/// centimetres.
inline bool agree(const geometry::Pose& measured, const geometry::Pose& truth) {
  return is_within(measured.inverse() * truth, 0.15, 0.087);
}

}  // namespace rds::evaluation
