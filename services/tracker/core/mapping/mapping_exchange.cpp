// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/mapping_exchange.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "services/tracker/core/map/covisibility.hpp"
#include "services/tracker/core/triangulation/triangulated_points.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kFreeKeyframes = 15;  // moved by bundle adjustment, the centre included
constexpr std::size_t kHolders = 12;        // keyframes that also see the points, and hold them
constexpr std::size_t kJobPoints = 1600;    // of one job

/// Points of the free keyframes, the most observed first if there are too many.
std::vector<PointId> points_of(const SlamMap& map, const std::set<KeyframeId>& keyframes) {
  std::set<PointId> all;
  for (const KeyframeId k : keyframes)
    for (const PointId p : map.keyframe(k)->points)
      if (map.point(p) != nullptr) all.insert(p);
  std::vector<PointId> chosen(all.begin(), all.end());
  if (chosen.size() > kJobPoints) {
    std::ranges::stable_sort(chosen, std::ranges::greater{},
                             [&](PointId p) { return map.point(p)->observations.size(); });
    chosen.resize(kJobPoints);
    std::ranges::sort(chosen);
  }
  return chosen;
}

/// Keyframes outside `free` that see most of the points.
std::set<KeyframeId> holders(const SlamMap& map, const std::vector<PointId>& points,
                             const std::set<KeyframeId>& free) {
  std::map<KeyframeId, int> seen;
  for (const PointId p : points)
    for (const Observation& o : map.point(p)->observations)
      if (!free.contains(o.keyframe)) ++seen[o.keyframe];
  std::vector<std::pair<KeyframeId, int>> ranked(seen.begin(), seen.end());
  std::ranges::stable_sort(ranked, std::ranges::greater{}, &std::pair<KeyframeId, int>::second);
  std::set<KeyframeId> chosen;
  for (std::size_t i = 0; i < std::min(ranked.size(), kHolders); ++i) chosen.insert(ranked[i].first);
  return chosen;
}

/// Makes a point that no feature has taken, or moved with, meanwhile.
void make_point(SlamMap& map, KeyframeId creator, const LocalMappingResult::MadePoint& made) {
  const auto is_free = [&](const LocalMappingResult::FeatureOfKeyframe& f) {
    const Keyframe* k = std::as_const(map).keyframe(f.keyframe);
    return k != nullptr && k->points[f.feature] == kNoId && !k->movable[f.feature];
  };
  if (!std::ranges::all_of(made.seen, is_free)) return;
  const auto& first = made.seen.front();
  MapPoint& point = map.add_point(made.position, first.keyframe, first.feature);
  point.created_by = creator;
  point.is_triangulated = true;
  for (const auto& f : made.seen) map.observe(point.id, f.keyframe, f.feature);
  update_from_observations(map, point);
}

}  // namespace

LocalMappingJob make_mapping_job(const SlamMap& map, KeyframeId id) {
  LocalMappingJob job;
  job.keyframe = id;
  job.next_keyframe = map.records().next_id();
  job.next_point = map.points().next_id();
  const Keyframe* centre = map.keyframe(id);
  if (centre == nullptr) return job;
  std::set<KeyframeId> free;
  if (!map.records().is_fixed(id)) free.insert(id);
  for (const CovisibleKeyframe& c : centre->covisible)
    if (!map.records().is_fixed(c.id) && free.size() < kFreeKeyframes) free.insert(c.id);
  const auto points = points_of(map, free);
  const auto fixed = holders(map, points, free);
  std::set<KeyframeId> all(free);
  all.insert(id);
  all.insert(fixed.begin(), fixed.end());
  const bool has_gauge = all.size() > free.size() || free.contains(0);
  for (const KeyframeId k : all) {
    const Keyframe& keyframe = *map.keyframe(k);
    // Without a holder the oldest keyframe fixes the gauge.
    const bool is_fixed =
        k == 0 || keyframe.pose_is_given || !free.contains(k) || (!has_gauge && k == *all.begin());
    job.keyframes.push_back({k, keyframe.map_from_camera, keyframe.features, keyframe.points,
                             keyframe.movable, keyframe.motion, keyframe.given_fx, is_fixed});
  }
  for (const PointId p : points) job.points.push_back(*map.point(p));
  return job;
}

void apply_mapping_result(SlamMap& map, const LocalMappingResult& result) {
  if (!map.records().contains(result.keyframe)) return;
  const Pose centre_before = map.pose_of(result.keyframe);
  for (const auto& moved : result.keyframes)
    if (Keyframe* k = map.keyframe(moved.id)) k->map_from_camera = moved.map_from_camera;
  for (const auto& moved : result.points)
    if (MapPoint* p = map.point(moved.id)) p->position = moved.position;
  const Pose moved_from_before = map.pose_of(result.keyframe) * centre_before.inverse();
  const auto move_keyframe = [&](Keyframe& k) {
    if (!k.pose_is_given) k.map_from_camera = moved_from_before * k.map_from_camera;
  };
  const auto move_point = [&](MapPoint& p) {
    if (p.created_by >= result.next_keyframe) p.position = moved_from_before * p.position;
  };
  map.keyframes().for_each(move_keyframe, result.next_keyframe);
  map.points().for_each(move_point, result.next_point);
  std::vector<PointId> seen_otherwise;
  for (const auto& o : result.added)
    if (map.observe(o.point, o.keyframe, o.feature)) seen_otherwise.push_back(o.point);
  for (const auto& f : result.fused) merge_points(map, f.keep, f.drop);
  for (const auto& o : result.removed) {
    map.forget(o.point, o.keyframe);
    seen_otherwise.push_back(o.point);
  }
  for (const PointId id : seen_otherwise)
    if (MapPoint* p = map.point(id)) update_from_observations(map, *p);
  for (const auto& moved : result.points)
    if (MapPoint* p = map.point(moved.id)) update_view(map, *p);
  for (const PointId id : seen_otherwise) erase_if_unknown(map, id);
  for (const auto& made : result.made) make_point(map, result.keyframe, made);
  update_covisibility(map, result.keyframe);
}

void apply_correction(SlamMap& map, std::span<const KeyframePose> corrected) {
  std::map<KeyframeId, Pose> corrected_from_before;
  for (const KeyframePose& k : corrected)
    if (map.records().contains(k.id) && !map.records().is_fixed(k.id) && map.records().is_placed(k.id) &&
        geometry::is_finite(k.map_from_camera))
      corrected_from_before[k.id] = k.map_from_camera * map.pose_of(k.id).inverse();
  if (corrected_from_before.empty()) return;
  const Pose still = Pose::Identity();
  const auto motion = [&](KeyframeId id) -> const Pose& {
    if (map.records().is_fixed(id) || !map.records().is_placed(id)) return still;
    auto next = corrected_from_before.upper_bound(id);
    return next == corrected_from_before.begin() ? next->second : std::prev(next)->second;
  };
  std::vector<KeyframePose> all = keyframe_poses(map, map.records().first_free());
  for (KeyframePose& k : all) k.map_from_camera = motion(k.id) * k.map_from_camera;
  map.points().for_each([&](MapPoint& p) { p.position = motion(p.created_by) * p.position; });
  for (const KeyframePose& k : all)
    if (map.keyframe(k.id) != nullptr) set_pose(map, k.id, k.map_from_camera);
  for (const KeyframePose& k : all)
    if (map.keyframe(k.id) == nullptr) set_pose(map, k.id, k.map_from_camera);
  map.points().for_each([&](MapPoint& p) { update_view(map, p); });
}

}  // namespace rds::tracker
