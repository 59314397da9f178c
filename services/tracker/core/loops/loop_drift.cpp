// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/loops/loop_drift.hpp"

#include <algorithm>
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
constexpr double kDriftRad = 0.01;
constexpr double kDriftRadPerM = 0.003;  // four times what is measured in a room
constexpr double kSpeedMPerS = 1;        // of a camera that is carried, or of a robot
constexpr double kTurnRadPerS = 1;
constexpr double kNsPerSecond = 1e9;

double distance(const SlamMap& map, KeyframeId a, KeyframeId b) {
  return (map.keyframe(a)->map_from_camera.translation() - map.keyframe(b)->map_from_camera.translation())
      .norm();
}

double angle_of(const Pose& pose) {
  return Eigen::AngleAxisd(pose.linear()).angle();
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

std::optional<double> way_of(const SlamMap& map, KeyframeId from, KeyframeId to) {
  return way_between(map, map.records().anchor_of(from).first, map.records().anchor_of(to).first);
}

}  // namespace

std::optional<SubmapBorder> border_of(const KeyframeRecords& records, SubmapId older, SubmapId younger) {
  const auto& rows = records.submaps().rows();
  const auto row = std::ranges::find(rows, younger, [](const auto& r) { return r.second; });
  if (row == rows.end() || !records.contains(row->first)) return std::nullopt;
  for (KeyframeId id = row->first; id-- > 0;)
    if (records.contains(id) && records.submaps().of(id) == older) {
      const std::int64_t gap_ns = records[row->first].stamp_ns - records[id].stamp_ns;
      return SubmapBorder{id, row->first, static_cast<double>(gap_ns) / kNsPerSecond};
    }
  return std::nullopt;
}

namespace {

std::optional<LoopDrift> drift_between_submaps(const SlamMap& map, const geometry::LoopMatch& loop) {
  const KeyframeRecords& records = map.records();
  const bool later_is_younger = records.submaps().of(loop.later) > records.submaps().of(loop.earlier);
  const KeyframeId younger = later_is_younger ? loop.later : loop.earlier;
  const KeyframeId older = later_is_younger ? loop.earlier : loop.later;
  const auto border = border_of(records, records.submaps().of(older), records.submaps().of(younger));
  if (!border) return std::nullopt;
  const auto way = way_of(map, older, border->before);
  const auto way_on = way_of(map, border->first, younger);
  if (!way || !way_on) return std::nullopt;
  const Pose earlier_from_later =
      map.pose_of(loop.earlier) * loop.earlier_from_later * map.pose_of(loop.later).inverse();
  const Pose older_from_younger = later_is_younger ? earlier_from_later : earlier_from_later.inverse();
  const Pose before_from_first =
      map.pose_of(border->before).inverse() * older_from_younger * map.pose_of(border->first);
  return LoopDrift{before_from_first.translation().norm(), *way + *way_on, border->gap_s,
                   angle_of(before_from_first)};
}

double sigma_m(const LoopDrift& drift) {
  return kDriftM + kDriftPerM * drift.way_m + kSpeedMPerS * drift.gap_s;
}

double sigma_rad(const LoopDrift& drift) {
  return kDriftRad + kDriftRadPerM * drift.way_m + kTurnRadPerS * drift.gap_s;
}

}  // namespace

double LoopDrift::log_odds() const {
  const double variance = std::pow(sigma_m(*this), 2);
  const double turned = turned_rad / sigma_rad(*this);
  const double here =
      std::exp(-(moved_m * moved_m / variance + turned * turned) / 2) / (2 * std::numbers::pi * variance);
  return std::log((1 - kAstray) * here * kFloorM2 + kAstray);
}

std::optional<double> LoopDrift::reach_m() const {
  const double sigma = sigma_m(*this);
  const double rarer = kFloorM2 / (2 * std::numbers::pi * sigma * sigma);
  if (gap_s < 0 || rarer <= 1) return std::nullopt;
  return sigma * std::sqrt(2 * std::log(rarer));
}

std::optional<LoopDrift> drift_of(const SlamMap& map, const geometry::LoopMatch& loop) {
  const Submaps& submaps = map.records().submaps();
  if (submaps.of(loop.earlier) != submaps.of(loop.later)) {
    const auto drift = drift_between_submaps(map, loop);
    return drift && drift->reach_m() ? drift : std::nullopt;
  }
  const auto way = way_of(map, loop.earlier, loop.later);
  if (!way) return std::nullopt;
  const Pose later_from_seen =
      map.pose_of(loop.later).inverse() * map.pose_of(loop.earlier) * loop.earlier_from_later;
  return LoopDrift{later_from_seen.translation().norm(), *way, 0, angle_of(later_from_seen)};
}

}  // namespace rds::tracker
