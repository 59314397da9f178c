// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
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

/// Detections at the newest keyframes. One picture can deceive; several in a row that ask for the same
/// correction do not. Source: Mur-Artal & Tardós 2017 (consecutive detections). Deviation: the corrections
/// agree, not the places.
class LoopHistory {
 public:
  /// Adds a detection; returns those, this one last, that agree with it if they are of three different
  /// keyframes among the newest six, or nothing while they are too few.
  std::vector<LoopDetection> add(const LoopDetection& detection);
  void clear() { detections_.clear(); }

 private:
  std::deque<LoopDetection> detections_;
};

}  // namespace rds::loop_closer
