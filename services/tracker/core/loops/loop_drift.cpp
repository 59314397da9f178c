// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/loops/loop_drift.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <queue>
#include <utility>
#include <vector>

namespace rds::tracker {
namespace {

constexpr double kAstray = 0.03;     // ε
constexpr double kFloorM2 = 100;     // A: a few rooms that could look alike
constexpr double kDriftM = 0.1;      // of keyframes side by side that share no point
constexpr double kDriftPerM = 0.02;  // visual odometry with depth drifts by .2 to 1 %, among people more

double distance(const SlamMap& map, KeyframeId a, KeyframeId b) {
  return (map.keyframe(a)->map_from_camera.translation() - map.keyframe(b)->map_from_camera.translation())
      .norm();
}

/// The shortest way over covisible keyframes (Dijkstra 1959).
std::optional<double> way_between(const SlamMap& map, KeyframeId from, KeyframeId to) {
  using Step = std::pair<double, KeyframeId>;
  std::map<KeyframeId, double> ways{{from, 0}};
  std::priority_queue<Step, std::vector<Step>, std::greater<>> open;
  open.emplace(0, from);
  while (!open.empty()) {
    const auto [way, id] = open.top();
    open.pop();
    if (id == to) return way;
    if (way > ways[id]) continue;
    for (const CovisibleKeyframe& next : map.keyframe(id)->covisible) {
      const double longer = way + distance(map, id, next.id);
      const auto [known, is_new] = ways.try_emplace(next.id, longer);
      if (!is_new && known->second <= longer) continue;
      known->second = longer;
      open.emplace(longer, next.id);
    }
  }
  return std::nullopt;
}

}  // namespace

double LoopDrift::log_odds() const {
  const double variance = std::pow(kDriftM + kDriftPerM * way_m, 2);
  const double here = std::exp(-moved_m * moved_m / (2 * variance)) / (2 * std::numbers::pi * variance);
  return std::log((1 - kAstray) * here * kFloorM2 + kAstray);
}

std::optional<LoopDrift> drift_of(const SlamMap& map, const geometry::LoopMatch& loop) {
  const KeyframeRecords& records = map.records();
  const auto way =
      way_between(map, records.anchor_of(loop.earlier).first, records.anchor_of(loop.later).first);
  if (!way) return std::nullopt;
  const Pose seen = map.pose_of(loop.earlier) * loop.earlier_from_later;
  return LoopDrift{(seen.translation() - map.pose_of(loop.later).translation()).norm(), *way};
}

}  // namespace rds::tracker
