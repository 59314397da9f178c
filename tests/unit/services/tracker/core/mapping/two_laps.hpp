// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "services/tracker/core/map/covisibility.hpp"
#include "services/tracker/core/map/slam_map.hpp"
#include "tests/unit/services/tracker/core/synthetic_scene.hpp"

namespace rds::tracker::test {

/// A map of two laps past the same points that nothing joins: keyframes 0 to 4 stand where they are, 5 to 9
/// stand there again but for a drift, and have made points of their own.
class TwoLaps {
 public:
  static constexpr KeyframeId kPerLap = 5;
  static constexpr std::size_t kPoints = 500;

  explicit TwoLaps(const Pose& drifted_by) : drift(drifted_by) {
    for (KeyframeId k = 0; k < 2 * kPerLap; ++k) add_keyframe(k, k < kPerLap ? first_lap : second_lap);
  }

  static Pose truth(KeyframeId k) {
    const auto step = static_cast<double>(k % kPerLap);
    return pose(0.08 * step, 0.01 * step, 0, -0.03 * step);
  }
  /// What a loop closer measures between the last keyframe and the same view a lap before.
  static LoopMatch loop(const Pose& error = Pose::Identity()) {
    return {2 * kPerLap - 1, kPerLap - 2, truth(kPerLap - 2).inverse() * truth(2 * kPerLap - 1) * error};
  }
  [[nodiscard]] int shared(KeyframeId a, KeyframeId b) const {
    for (const CovisibleKeyframe& c : map.keyframe(a)->covisible)
      if (c.id == b) return c.weight;
    return 0;
  }

  Pose drift;
  std::mt19937 random{6};
  std::vector<Eigen::Vector3d> points = random_points(kPoints, random);
  std::vector<PointId> first_lap = std::vector<PointId>(kPoints, kNoId);  // that each lap made of the points
  std::vector<PointId> second_lap = std::vector<PointId>(kPoints, kNoId);
  SlamMap map{ScalePyramid(8, 1.2)};

  /// Adds a keyframe with this view, whose points are those of a lap.
  void add_keyframe(KeyframeId k, std::vector<PointId>& ids) {
    const Pose map_from_world = &ids == &first_lap ? Pose::Identity() : drift;
    const auto view = view_of(points, truth(k), 0.3, random);
    const KeyframeId id =
        map.add_keyframe(static_cast<std::int64_t>(k), map_from_world * truth(k), view.features).id;
    for (std::uint32_t f = 0; f < view.point.size(); ++f) {
      PointId& p = ids[view.point[f]];
      if (map.point(p) == nullptr)
        p = map.add_point(map_from_world * points[view.point[f]], id, f).id;
      else
        map.observe(p, id, f);
    }
    update_covisibility(map, id);
    map.points().for_each([this](MapPoint& p) { update_from_observations(map, p); });
  }
};

}  // namespace rds::tracker::test
