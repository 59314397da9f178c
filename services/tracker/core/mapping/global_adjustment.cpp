// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/global_adjustment.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "services/tracker/core/mapping/mapping_scene.hpp"
#include "services/tracker/core/triangulation/triangulated_points.hpp"

namespace rds::tracker {
namespace {

constexpr int kIterations =
    10;  // of each of the two passes; from a closed pose graph later ones move nothing

/// The keyframe of the snapshot that a newer one shares most points with; else the newest one of its submap
/// before.
KeyframeId reference_of(const SlamMap& map, const Keyframe& keyframe, KeyframeId next_keyframe) {
  const auto known = std::ranges::find_if(keyframe.covisible,
                                          [&](const CovisibleKeyframe& c) { return c.id < next_keyframe; });
  if (known != keyframe.covisible.end()) return known->id;
  KeyframeId newest = kNoId;
  const Submaps& submaps = map.records().submaps();
  map.keyframes().for_each([&](const Keyframe& k) {
    if (k.id < next_keyframe && submaps.of(k.id) == submaps.of(keyframe.id)) newest = k.id;
  });
  return newest;
}

/// The poses of keyframes before a change, and how far they have moved since.
class Motion {
 public:
  explicit Motion(const SlamMap& map) : map_(map) {}
  void note(KeyframeId id) { before_.try_emplace(id, map_.pose_of(id)); }
  [[nodiscard]] Pose now_from_before(KeyframeId id) const {
    return map_.pose_of(id) * before_.at(id).inverse();
  }

 private:
  const SlamMap& map_;
  std::map<KeyframeId, Pose> before_;
};

}  // namespace

LocalMappingJob make_global_job(const SlamMap& map) {
  LocalMappingJob job;
  job.next_keyframe = map.records().next_id();
  job.next_point = map.points().next_id();
  const KeyframeRecords& records = map.records();
  std::set<KeyframeId> seeing;
  map.points().for_each([&](const MapPoint& p) {
    const auto is_free = [&](const Observation& o) {
      return !records.is_fixed(o.keyframe) && records.is_placed(o.keyframe);
    };
    if (!std::ranges::any_of(p.observations, is_free)) return;
    job.points.push_back(p);
    for (const Observation& o : p.observations) seeing.insert(o.keyframe);
  });
  const bool has_gauge = !seeing.empty() && (*seeing.begin() == 0 || records.is_fixed(*seeing.begin()));
  for (const KeyframeId id : seeing) {
    const Keyframe& k = *map.keyframe(id);
    const bool is_fixed =
        id == 0 || records.is_fixed(id) || k.pose_is_given || (!has_gauge && id == *seeing.begin());
    job.keyframes.push_back(
        {id, k.map_from_camera, k.features, k.points, k.movable, k.motion, k.given_fx, is_fixed});
  }
  return job;
}

std::optional<LocalMappingResult> run_global_adjustment(const LocalMappingJob& job,
                                                        const std::stop_token& stop) {
  LocalMappingResult result;
  result.next_keyframe = job.next_keyframe;
  result.next_point = job.next_point;
  result.revision = job.revision;
  MappingScene scene(job);
  (void)adjust_bundle(scene, {.iterations = kIterations, .is_sparse = true, .stop = stop}, result);
  return stop.stop_requested() ? std::nullopt : std::optional(std::move(result));
}

void apply_global_adjustment(SlamMap& map, const LocalMappingResult& result) {
  Motion motion(map);
  std::map<KeyframeId, KeyframeId> reference_of_new;
  const auto note = [&](const Keyframe& k) {
    reference_of_new[k.id] = reference_of(map, k, result.next_keyframe);
    motion.note(k.id);
    if (reference_of_new[k.id] != kNoId) motion.note(reference_of_new[k.id]);
  };
  std::as_const(map).keyframes().for_each(note, result.next_keyframe);
  std::as_const(map).points().for_each([&](const MapPoint& p) { motion.note(p.created_by); },
                                       result.next_point);

  for (const auto& moved : result.keyframes)
    if (Keyframe* k = map.keyframe(moved.id)) k->map_from_camera = moved.map_from_camera;
  for (const auto& moved : result.keyframes)
    if (map.keyframe(moved.id) == nullptr)
      set_pose(map, moved.id, moved.map_from_camera);  // culled meanwhile
  for (const auto& [id, reference] : reference_of_new)
    if (reference != kNoId)
      map.keyframe(id)->map_from_camera = motion.now_from_before(reference) * map.pose_of(id);
  for (const auto& moved : result.points)
    if (MapPoint* p = map.point(moved.id)) p->position = moved.position;
  map.points().for_each([&](MapPoint& p) { p.position = motion.now_from_before(p.created_by) * p.position; },
                        result.next_point);

  std::set<PointId> seen_otherwise;
  for (const auto& o : result.removed) {
    map.forget(o.point, o.keyframe);
    seen_otherwise.insert(o.point);
  }
  map.points().for_each([&](MapPoint& p) {
    seen_otherwise.contains(p.id) ? update_from_observations(map, p) : update_view(map, p);
  });
  for (const PointId id : seen_otherwise) erase_if_unknown(map, id);
}

}  // namespace rds::tracker
