// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "services/tracker/core/features/feature.hpp"

namespace rds::tracker {

class SlamMap;
using KeyframeId = std::uint64_t;
using PointId = std::uint64_t;
inline constexpr std::uint64_t kNoId = std::numeric_limits<std::uint64_t>::max();
/// Ids from here on are no keyframe's or point's: files that name them are wrong.
inline constexpr KeyframeId kMaxKeyframes = 100'000'000;
inline constexpr PointId kMaxPoints = 100'000'000'000;

/// A feature of a keyframe that sees a map point.
struct Observation {
  KeyframeId keyframe = kNoId;
  std::uint32_t feature = 0;
};

struct MapPoint {
  PointId id = kNoId;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, map
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    // mean direction from the observing cameras
  double level_0_distance = 0;                         // m; from there it would show at pyramid level 0
  Descriptor descriptor{};                             // nearest to all others of its features
  std::vector<Observation> observations;               // by ascending keyframe, each keyframe once
  KeyframeId created_by = kNoId;
  bool is_triangulated = false;    // it was made without depth; not of a map that was saved
  std::uint32_t visible = 1;       // frames that should have seen it
  std::uint32_t found = 1;         // frames that did
  std::int64_t last_found_ns = 0;  // time of the newest of these
  std::uint64_t mark = 0;          // of the last selection that took it (select_local_map)
};

/// Computes normal and level_0_distance from the point's observations: after it or its observers have moved.
/// Source: Mur-Artal et al. 2015, §III-C.
void update_view(const SlamMap& map, MapPoint& point);
/// The same, and the descriptor: after other keyframes see the point.
void update_from_observations(const SlamMap& map, MapPoint& point);

}  // namespace rds::tracker
