// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/local_map.hpp"

#include <algorithm>
#include <map>

namespace rds::tracker {
namespace {

constexpr std::size_t kLocalKeyframes = 24;
constexpr std::size_t kLocalPoints = 4000;
constexpr std::size_t kNeighboursEach = 3;
constexpr std::size_t kStableObservers = 3;  // keyframes and …
constexpr std::uint32_t kStableFound = 8;    // frames that found a stable point

std::vector<CovisibleKeyframe> keyframes_that_share_points(const SlamMap& map,
                                                           std::span<const PointId> seen) {
  std::map<KeyframeId, int> votes;
  for (const PointId id : seen)
    if (const MapPoint* point = map.point(id))
      for (const Observation& o : point->observations) ++votes[o.keyframe];
  std::vector<CovisibleKeyframe> sharing;
  sharing.reserve(votes.size());
  for (const auto& [id, weight] : votes) sharing.push_back({id, weight});
  std::ranges::stable_sort(sharing, std::ranges::greater{}, &CovisibleKeyframe::weight);
  return sharing;
}

}  // namespace

LocalMap select_local_map(SlamMap& map, std::span<const PointId> seen, std::uint64_t mark) {
  LocalMap local;
  const auto add = [&](KeyframeId id) {
    if (local.keyframes.size() < kLocalKeyframes &&
        std::ranges::find(local.keyframes, id) == local.keyframes.end())
      local.keyframes.push_back(id);
  };
  for (const CovisibleKeyframe& k : keyframes_that_share_points(map, seen)) add(k.id);
  if (local.keyframes.empty()) return local;
  local.reference = local.keyframes.front();
  for (const KeyframeId direct : std::vector(local.keyframes)) {
    const auto& neighbours = map.keyframe(direct)->covisible;
    for (std::size_t n = 0; n < std::min(neighbours.size(), kNeighboursEach); ++n) add(neighbours[n].id);
  }
  for (const PointId id : seen)
    if (MapPoint* point = map.point(id)) point->mark = mark;
  for (const KeyframeId id : local.keyframes)
    for (const PointId p : map.keyframe(id)->points) {
      MapPoint* point = map.point(p);
      if (point == nullptr || point->mark == mark) continue;
      if (local.points.size() >= kLocalPoints) return local;
      point->mark = mark;
      local.points.push_back(p);
    }
  return local;
}

std::vector<Eigen::Vector3f> stable_points(const SlamMap& map, std::span<const PointId> points,
                                           const Pose& camera_from_map) {
  std::vector<Eigen::Vector3f> stable;
  for (const PointId id : points) {
    const MapPoint& point = *map.point(id);
    if (point.observations.size() < kStableObservers || point.found < kStableFound ||
        2 * point.found < point.visible)
      continue;
    stable.push_back((camera_from_map * point.position).cast<float>());
  }
  return stable;
}

}  // namespace rds::tracker
