// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/slam_map.hpp"

#include <algorithm>
#include <stdexcept>

#include "services/tracker/core/map/covisibility.hpp"

namespace rds::tracker {
namespace {

auto find_observation(MapPoint& point, KeyframeId keyframe) {
  return std::ranges::lower_bound(point.observations, keyframe, {}, &Observation::keyframe);
}

}  // namespace

Keyframe& SlamMap::add_keyframe(std::int64_t stamp_ns, const Pose& map_from_camera,
                                std::shared_ptr<const FeatureSet> features) {
  Keyframe keyframe;
  keyframe.id = records().add(stamp_ns);
  keyframe.stamp_ns = keyframe.time_ns = stamp_ns;
  keyframe.map_from_camera = map_from_camera;
  keyframe.points.assign(features->size(), kNoId);
  keyframe.movable.resize(features->size());
  for (std::size_t i = 0; i < features->size(); ++i) keyframe.movable[i] = (*features)[i].movable;
  keyframe.features = std::move(features);
  keyframes().skip_to(keyframe.id);
  return keyframes().emplace(std::move(keyframe));
}

MapPoint& SlamMap::add_point(const Eigen::Vector3d& position, KeyframeId keyframe, std::uint32_t feature) {
  if (this->keyframe(keyframe) == nullptr) throw std::out_of_range("SlamMap::add_point: no such keyframe");
  MapPoint fresh;
  fresh.id = points().next_id();
  fresh.position = position;
  fresh.created_by = keyframe;
  MapPoint& point = points().emplace(std::move(fresh));
  observe(point.id, keyframe, feature);
  update_from_observations(*this, point);
  return point;
}

bool SlamMap::observe(PointId point, KeyframeId keyframe, std::uint32_t feature) {
  Keyframe* k = this->keyframe(keyframe);
  MapPoint* p = this->point(point);
  if (k == nullptr || p == nullptr || feature >= k->points.size()) return false;
  if (k->points[feature] != kNoId || k->movable[feature]) return false;
  const auto place = find_observation(*p, keyframe);
  if (place != p->observations.end() && place->keyframe == keyframe) return false;
  p->observations.insert(place, {keyframe, feature});
  k->points[feature] = point;
  return true;
}

void SlamMap::forget(PointId point, KeyframeId keyframe) {
  MapPoint* p = this->point(point);
  if (p == nullptr) return;
  const auto place = find_observation(*p, keyframe);
  if (place == p->observations.end() || place->keyframe != keyframe) return;
  if (Keyframe* k = this->keyframe(keyframe)) k->points[place->feature] = kNoId;
  p->observations.erase(place);
  if (p->observations.empty()) points().erase(point);
}

void SlamMap::erase_point(PointId point) {
  MapPoint* p = this->point(point);
  if (p == nullptr) return;
  for (const Observation& o : p->observations)
    if (Keyframe* k = keyframe(o.keyframe)) k->points[o.feature] = kNoId;
  points().erase(point);
}

void SlamMap::cull_keyframe(KeyframeId id) {
  const Keyframe* culled = keyframe(id);
  if (culled == nullptr || keyframes().size() < 2) return;
  KeyframeId anchor = kNoId;
  if (!culled->covisible.empty()) {
    anchor = culled->covisible.front().id;
  } else {
    std::as_const(*this).keyframes().for_each([&](const Keyframe& other) {
      if (other.id != id && (anchor == kNoId || other.id < id)) anchor = other.id;
    });
  }
  records().set_anchor(id, anchor, pose_of(anchor).inverse() * culled->map_from_camera);
  for (const PointId p : std::vector(culled->points)) {
    forget(p, id);
    if (MapPoint* point = this->point(p)) update_from_observations(*this, *point);
  }
  remove_covisibility(*this, *culled);
  keyframes().erase(id);
}

Pose SlamMap::pose_of(KeyframeId id) const {
  if (const auto& saved = records()[id].saved_pose) return *saved;
  const auto [anchor, anchor_from_camera] = records().anchor_of(id);
  return keyframe(anchor)->map_from_camera * anchor_from_camera;
}

void set_pose(SlamMap& map, KeyframeId id, const Pose& map_from_camera) {
  if (Keyframe* k = map.keyframe(id)) {
    k->map_from_camera = map_from_camera;
  } else if (map.records().contains(id)) {
    const KeyframeId anchor = map.records()[id].anchor;
    map.records().set_anchor(id, anchor, map.pose_of(anchor).inverse() * map_from_camera);
  }
}

void merge_points(SlamMap& map, PointId keep, PointId drop) {
  MapPoint* kept = map.point(keep);
  const MapPoint* dropped = map.point(drop);
  if (keep == drop || kept == nullptr || dropped == nullptr) return;
  const auto observations = dropped->observations;
  kept->visible += dropped->visible;
  kept->found += dropped->found;
  kept->is_triangulated = kept->is_triangulated && dropped->is_triangulated;
  kept->last_found_ns = std::max(kept->last_found_ns, dropped->last_found_ns);
  map.erase_point(drop);
  for (const Observation& o : observations) map.observe(keep, o.keyframe, o.feature);
  update_from_observations(map, *kept);
}

std::vector<KeyframePose> keyframe_poses(const SlamMap& map, KeyframeId first, SubmapId submap) {
  std::vector<KeyframePose> poses;
  const auto add = [&](const KeyframeRecord& r) {
    if (map.records().submaps().of(r.id) == submap) poses.push_back({r.id, r.stamp_ns, map.pose_of(r.id)});
  };
  map.records().all().for_each(add, first);
  return poses;
}

}  // namespace rds::tracker
