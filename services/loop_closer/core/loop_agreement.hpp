// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/geometry/pose.hpp"

namespace rds::loop_closer {

/// A geometrically verified pair of keyframes (places in the graph) that stand elsewhere than their poses
/// say.
struct LoopDetection {
  std::size_t query = 0;
  std::size_t candidate = 0;
  geometry::Pose candidate_from_query = geometry::Pose::Identity();  // measured
  geometry::Pose correction = geometry::Pose::Identity();  // measured map_from_query = correction * estimated
  Eigen::Vector3d query_in_map = Eigen::Vector3d::Zero();  // estimated position
};

/// True if both corrections move the keyframes between them to the same place.
[[nodiscard]] bool is_consistent(const LoopDetection& a, const LoopDetection& b);

/// The most detections that agree with one of them on where the keyframe stands; of as many, those of the
/// first. A view that was laid on the wrong one of two that look alike stands against the others.
[[nodiscard]] std::vector<LoopDetection> most_that_agree(std::span<const LoopDetection> detections);

}  // namespace rds::loop_closer
