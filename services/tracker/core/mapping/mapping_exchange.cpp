// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/mapping_exchange.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace rds::tracker {
namespace {

/// Points of the free keyframes, the most observed first if there are too many.
std::vector<PointId> points_of(const SlamMap& map, const std::set<KeyframeId>& keyframes, int max_points) {
  std::set<PointId> all;
  for (const KeyframeId k : keyframes)
    for (const PointId p : map.keyframe(k)->points)
      if (map.point(p) != nullptr) all.insert(p);
  std::vector<PointId> chosen(all.begin(), all.end());
  const auto limit = static_cast<std::size_t>(max_points);
  if (chosen.size() > limit) {
    std::ranges::stable_sort(chosen, std::ranges::greater{},
                             [&](PointId p) { return map.point(p)->observations.size(); });
    chosen.resize(limit);
    std::ranges::sort(chosen);
  }
  return chosen;
}

/// Keyframes outside `free` that see most of the points.
std::set<KeyframeId> holders(const SlamMap& map, const std::vector<PointId>& points,
                             const std::set<KeyframeId>& free, int wanted) {
  std::map<KeyframeId, int> seen;
  for (const PointId p : points)
    for (const Observation& o : map.point(p)->observations)
      if (!free.contains(o.keyframe)) ++seen[o.keyframe];
  std::vector<std::pair<KeyframeId, int>> ranked(seen.begin(), seen.end());
  std::ranges::stable_sort(ranked, std::ranges::greater{}, &std::pair<KeyframeId, int>::second);
  std::set<KeyframeId> chosen;
  for (std::size_t i = 0; i < std::min(ranked.size(), static_cast<std::size_t>(wanted)); ++i)
    chosen.insert(ranked[i].first);
  return chosen;
}

}  // namespace

LocalMappingJob make_mapping_job(const SlamMap& map, KeyframeId id, const LocalMappingConfig& config) {
  LocalMappingJob job;
  job.keyframe = id;
  job.next_keyframe = map.next_keyframe_id();
  job.next_point = map.next_point_id();
  const Keyframe* centre = map.keyframe(id);
  if (centre == nullptr) return job;
  std::set<KeyframeId> free{id};
  for (const CovisibleKeyframe& c : centre->covisible)
    if (!map.is_fixed(c.id) && free.size() < static_cast<std::size_t>(config.free_keyframes))
      free.insert(c.id);
  const auto points = points_of(map, free, config.max_points);
  const auto fixed = holders(map, points, free, config.fixed_keyframes);
  std::set<KeyframeId> all(free);
  all.insert(fixed.begin(), fixed.end());
  const bool held = !fixed.empty() || free.contains(0);
  for (const KeyframeId k : all) {
    const Keyframe& keyframe = *map.keyframe(k);
    // Without a holder the oldest keyframe fixes the gauge.
    const bool is_fixed =
        k == 0 || keyframe.pose_is_given || fixed.contains(k) || (!held && k == *all.begin());
    job.keyframes.push_back({k, keyframe.map_from_camera, keyframe.features, keyframe.points,
                             keyframe.movable, keyframe.motion, keyframe.given_fx, is_fixed});
  }
  for (const PointId p : points) job.points.push_back(*map.point(p));
  return job;
}

void apply_mapping_result(SlamMap& map, const LocalMappingResult& result) {
  if (!map.knows(result.keyframe)) return;
  const Pose centre_before = map.pose_of(result.keyframe);
  for (const auto& moved : result.keyframes)
    if (Keyframe* k = map.keyframe(moved.id)) k->map_from_camera = moved.map_from_camera;
  for (const auto& moved : result.points)
    if (MapPoint* p = map.point(moved.id)) p->position = moved.position;
  const Pose moved_from_before = map.pose_of(result.keyframe) * centre_before.inverse();
  map.all_keyframes().for_each_from(result.next_keyframe, [&](Keyframe& k) {
    if (!k.pose_is_given) k.map_from_camera = moved_from_before * k.map_from_camera;
  });
  map.all_points().for_each_from(result.next_point, [&](MapPoint& p) {
    if (p.created_by >= result.next_keyframe) p.position = moved_from_before * p.position;
  });
  std::vector<PointId> seen_otherwise;
  for (const auto& o : result.added)
    if (map.observe(o.point, o.keyframe, o.feature)) seen_otherwise.push_back(o.point);
  for (const auto& f : result.fused) map.merge(f.keep, f.drop);
  for (const auto& o : result.removed) {
    map.forget(o.point, o.keyframe);
    seen_otherwise.push_back(o.point);
  }
  for (const PointId id : seen_otherwise)
    if (MapPoint* p = map.point(id)) map.refresh(*p);
  for (const auto& moved : result.points)
    if (MapPoint* p = map.point(moved.id)) map.refresh_view(*p);
  map.update_covisibility(result.keyframe);
}

void apply_correction(SlamMap& map, std::span<const KeyframePose> corrected) {
  std::map<KeyframeId, Pose> corrected_from_before;
  for (const KeyframePose& k : corrected)
    if (map.knows(k.id) && !map.is_fixed(k.id) && geometry::is_finite(k.map_from_camera))
      corrected_from_before[k.id] = k.map_from_camera * map.pose_of(k.id).inverse();
  if (corrected_from_before.empty()) return;
  const Pose still = Pose::Identity();
  const auto motion = [&](KeyframeId id) -> const Pose& {
    if (map.is_fixed(id)) return still;
    auto next = corrected_from_before.upper_bound(id);
    return next == corrected_from_before.begin() ? next->second : std::prev(next)->second;
  };
  std::vector<KeyframePose> all = map.keyframe_poses(map.first_free_keyframe());
  for (KeyframePose& k : all) k.map_from_camera = motion(k.id) * k.map_from_camera;
  map.all_points().for_each([&](MapPoint& p) { p.position = motion(p.created_by) * p.position; });
  for (const KeyframePose& k : all)
    if (map.keyframe(k.id) != nullptr) map.set_pose(k.id, k.map_from_camera);
  for (const KeyframePose& k : all)
    if (map.keyframe(k.id) == nullptr) map.set_pose(k.id, k.map_from_camera);
  map.all_points().for_each([&](MapPoint& p) { map.refresh_view(p); });
}

}  // namespace rds::tracker
