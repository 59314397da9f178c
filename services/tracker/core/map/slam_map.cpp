// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/map/slam_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace rds::tracker {
namespace {

auto find_observation(MapPoint& point, KeyframeId keyframe) {
  return std::ranges::lower_bound(point.observations, keyframe, {}, &Observation::keyframe);
}

constexpr std::size_t kMaxTypicalOf = 12;  // newest observations that the descriptor is chosen from

/// The descriptor whose median distance to the others is smallest.
const Descriptor& most_typical(std::span<const Descriptor* const> descriptors) {
  const std::size_t count = descriptors.size();
  std::array<std::array<int, kMaxTypicalOf>, kMaxTypicalOf> distances{};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j)
      distances[i][j] = distances[j][i] = descriptor_distance(*descriptors[i], *descriptors[j]);
  const auto median = [count](std::array<int, kMaxTypicalOf>& row) {
    const auto middle = row.begin() + static_cast<std::ptrdiff_t>((count - 1) / 2);
    std::nth_element(row.begin(), middle, row.begin() + static_cast<std::ptrdiff_t>(count));
    return *middle;
  };
  std::array<int, kMaxTypicalOf> medians{};
  for (std::size_t i = 0; i < count; ++i) medians[i] = median(distances[i]);
  const auto best = std::min_element(medians.begin(), medians.begin() + static_cast<std::ptrdiff_t>(count));
  return *descriptors[static_cast<std::size_t>(best - medians.begin())];
}

}  // namespace

tl::expected<SlamMap, std::string> SlamMap::of(MapContents&& contents, const MapConfig& config,
                                               const ScalePyramid& pyramid) {
  SlamMap map(config, pyramid);
  map.keyframes_ = std::move(contents.keyframes);
  map.points_ = std::move(contents.points);
  map.records_ = std::move(contents.records);
  map.held_ = contents.held;
  const KeyframeId next = std::max(map.keyframes_.next_id(), map.records_.next_id());
  map.skip_keyframe_ids(next);
  std::string fault;
  const auto note = [&fault](std::string what) {
    if (fault.empty()) fault = std::move(what);
  };
  map.keyframes_.for_each([&](Keyframe& k) {
    k.points.assign(k.features->size(), kNoId);
    if (!map.knows(k.id)) note(fmt::format("keyframe {} without a record", k.id));
  });
  std::as_const(map.records_).for_each([&](const KeyframeRecord& r) {
    note(map.fault_of(r));
    if (r.pose_only) map.passing_[r.anchor].push_back(r.id);
  });
  map.points_.for_each([&](MapPoint& p) { note(map.connect(p)); });
  if (!fault.empty()) return tl::unexpected(fault);
  map.update_all_covisibility();
  return map;
}

/// Why a record's pose is none, or nothing.
std::string SlamMap::fault_of(const KeyframeRecord& record) const {
  const KeyframeRecord* r = &record;
  std::size_t steps = 0;
  while (r != nullptr && r->anchor != kNoId && ++steps <= records_.size()) r = records_.find(r->anchor);
  const bool is_hung = r != nullptr && r->anchor == kNoId && keyframes_.find(r->id) != nullptr;
  return is_hung ? "" : fmt::format("the pose of keyframe {} hangs on none that is there", record.id);
}

/// Lets the features see a point that knows which ones do. @return why that cannot be, or nothing.
std::string SlamMap::connect(MapPoint& point) {
  if (point.observations.empty()) return fmt::format("point {} that no keyframe sees", point.id);
  for (const Observation& o : point.observations) {
    Keyframe* k = keyframes_.find(o.keyframe);
    const bool is_free = k != nullptr && o.feature < k->points.size() && !k->movable[o.feature] &&
                         k->points[o.feature] == kNoId;
    if (!is_free) return fmt::format("point {} in keyframe {}, where it cannot be", point.id, o.keyframe);
    k->points[o.feature] = point.id;
  }
  refresh(point);
  return {};
}

Keyframe& SlamMap::add_keyframe(std::int64_t stamp_ns, const Pose& map_from_camera,
                                std::shared_ptr<const FeatureSet> features) {
  Keyframe keyframe;
  keyframe.id = keyframes_.next_id();
  keyframe.stamp_ns = keyframe.time_ns = stamp_ns;
  keyframe.map_from_camera = map_from_camera;
  keyframe.points.assign(features->size(), kNoId);
  keyframe.movable.resize(features->size());
  for (std::size_t i = 0; i < features->size(); ++i) keyframe.movable[i] = (*features)[i].movable;
  keyframe.features = std::move(features);
  records_.emplace({keyframe.id, stamp_ns, kNoId, Pose::Identity(), false});
  return keyframes_.emplace(std::move(keyframe));
}

KeyframeId SlamMap::add_pose_only(std::int64_t stamp_ns, const Pose& map_from_camera, KeyframeId anchor) {
  const KeyframeId id = keyframes_.skip_id();
  records_.emplace({id, stamp_ns, anchor, pose_of(anchor).inverse() * map_from_camera, false});
  return id;
}

KeyframeId SlamMap::add_passing(std::int64_t stamp_ns, const Pose& map_from_camera, KeyframeId anchor) {
  const KeyframeId id = add_pose_only(stamp_ns, map_from_camera, anchor);
  records_.find(id)->pose_only = true;
  passing_[anchor].push_back(id);
  if (config_.pose_only_s > 0) forget_passing(stamp_ns, anchor);
  return id;
}

void SlamMap::forget_passing(std::int64_t now_ns, KeyframeId anchor) {
  std::deque<KeyframeId>& passing = passing_[anchor];
  while (passing.size() > static_cast<std::size_t>(config_.pose_only_kept)) {
    const auto age_s = static_cast<double>(now_ns - record(passing.front()).stamp_ns) * 1e-9;
    if (std::abs(age_s) <= config_.pose_only_s) return;
    records_.erase(passing.front());
    passing.pop_front();
  }
}

void SlamMap::skip_keyframe_ids(KeyframeId next) {
  keyframes_.skip_to(next);
  records_.skip_to(next);
}

MapPoint& SlamMap::add_point(const Eigen::Vector3d& position, KeyframeId keyframe, std::uint32_t feature) {
  if (keyframes_.find(keyframe) == nullptr) throw std::out_of_range("SlamMap::add_point: no such keyframe");
  MapPoint fresh;
  fresh.id = points_.next_id();
  fresh.position = position;
  fresh.created_by = keyframe;
  MapPoint& point = points_.emplace(std::move(fresh));
  observe(point.id, keyframe, feature);
  refresh(point);
  return point;
}

bool SlamMap::observe(PointId point, KeyframeId keyframe, std::uint32_t feature) {
  Keyframe* k = keyframes_.find(keyframe);
  MapPoint* p = points_.find(point);
  if (k == nullptr || p == nullptr || feature >= k->points.size()) return false;
  if (k->points[feature] != kNoId || k->movable[feature]) return false;
  const auto place = find_observation(*p, keyframe);
  if (place != p->observations.end() && place->keyframe == keyframe) return false;
  p->observations.insert(place, {keyframe, feature});
  k->points[feature] = point;
  return true;
}

void SlamMap::forget(PointId point, KeyframeId keyframe) {
  MapPoint* p = points_.find(point);
  if (p == nullptr) return;
  const auto place = find_observation(*p, keyframe);
  if (place == p->observations.end() || place->keyframe != keyframe) return;
  if (Keyframe* k = keyframes_.find(keyframe)) k->points[place->feature] = kNoId;
  p->observations.erase(place);
  if (p->observations.empty()) points_.erase(point);
}

void SlamMap::erase_point(PointId point) {
  MapPoint* p = points_.find(point);
  if (p == nullptr) return;
  for (const Observation& o : p->observations)
    if (Keyframe* k = keyframes_.find(o.keyframe)) k->points[o.feature] = kNoId;
  points_.erase(point);
}

void SlamMap::merge(PointId keep, PointId drop) {
  MapPoint* kept = points_.find(keep);
  const MapPoint* dropped = points_.find(drop);
  if (keep == drop || kept == nullptr || dropped == nullptr) return;
  const auto observations = dropped->observations;
  kept->visible += dropped->visible;
  kept->found += dropped->found;
  kept->last_found_ns = std::max(kept->last_found_ns, dropped->last_found_ns);
  erase_point(drop);
  for (const Observation& o : observations) observe(keep, o.keyframe, o.feature);
  refresh(*kept);
}

void SlamMap::refresh(MapPoint& point) const {
  refresh_view(point);
  refresh_descriptor(point);
}

void SlamMap::refresh_view(MapPoint& point) const {
  if (point.observations.empty()) return;
  Eigen::Vector3d directions = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < point.observations.size(); ++i) {
    const Keyframe* k = keyframes_.find(point.observations[i].keyframe);
    const Eigen::Vector3d ray = point.position - k->map_from_camera.translation();
    const double distance = ray.norm();
    if (distance > 0) directions += ray / distance;
    if (i == 0)
      point.level_0_distance = distance * pyramid_.scale((*k->features)[point.observations[i].feature].level);
  }
  point.normal = directions.normalized();
}

void SlamMap::refresh_descriptor(MapPoint& point) const {
  if (point.observations.empty()) return;
  std::array<const Descriptor*, kMaxTypicalOf> newest{};
  const std::size_t count = std::min(point.observations.size(), kMaxTypicalOf);
  std::transform(point.observations.end() - static_cast<std::ptrdiff_t>(count), point.observations.end(),
                 newest.begin(), [this](const Observation& o) {
                   return &(*keyframes_.find(o.keyframe)->features)[o.feature].descriptor;
                 });
  point.descriptor = most_typical(std::span(newest).first(count));
}

void SlamMap::set_covisible(Keyframe& keyframe, KeyframeId other, int weight) const {
  std::erase_if(keyframe.covisible, [other](const CovisibleKeyframe& c) { return c.id == other; });
  if (weight <= 0) return;
  const auto place = std::ranges::find_if(keyframe.covisible, [&](const CovisibleKeyframe& c) {
    return c.weight < weight || (c.weight == weight && c.id > other);
  });
  keyframe.covisible.insert(place, {other, weight});
}

void SlamMap::update_covisibility(KeyframeId id) {
  Keyframe* keyframe = keyframes_.find(id);
  if (keyframe == nullptr) return;
  std::map<KeyframeId, int> shared;
  for (const PointId p : keyframe->points)
    if (const MapPoint* point = points_.find(p))
      for (const Observation& o : point->observations)
        if (o.keyframe != id) ++shared[o.keyframe];
  CovisibleKeyframe strongest;
  for (const auto& [other, weight] : shared)
    if (weight > strongest.weight) strongest = {other, weight};
  for (const CovisibleKeyframe& old : std::vector(keyframe->covisible))
    if (Keyframe* other = keyframes_.find(old.id)) set_covisible(*other, id, 0);
  keyframe->covisible.clear();
  for (const auto& [other, weight] : shared) {
    if (weight < config_.min_covisible_weight && other != strongest.id) continue;
    set_covisible(*keyframe, other, weight);
    set_covisible(*keyframes_.find(other), id, weight);
  }
}

void SlamMap::update_all_covisibility() {
  std::as_const(keyframes_).for_each([this](const Keyframe& k) { update_covisibility(k.id); });
}

void SlamMap::cull_keyframe(KeyframeId id) {
  Keyframe* keyframe = keyframes_.find(id);
  if (keyframe == nullptr || keyframes_.size() < 2) return;
  KeyframeId anchor = kNoId;
  if (!keyframe->covisible.empty()) {
    anchor = keyframe->covisible.front().id;
  } else {
    std::as_const(keyframes_).for_each([&](const Keyframe& other) {
      if (other.id != id && (anchor == kNoId || other.id < id)) anchor = other.id;
    });
  }
  KeyframeRecord& record = *records_.find(id);
  record.anchor = anchor;
  record.anchor_from_camera = pose_of(anchor).inverse() * keyframe->map_from_camera;
  for (const PointId p : std::vector(keyframe->points)) {
    forget(p, id);
    if (MapPoint* point = points_.find(p)) refresh(*point);
  }
  for (const CovisibleKeyframe& c : keyframe->covisible)
    if (Keyframe* other = keyframes_.find(c.id)) set_covisible(*other, id, 0);
  keyframes_.erase(id);
}

const KeyframeRecord& SlamMap::record(KeyframeId id) const {
  const KeyframeRecord* record = records_.find(id);
  if (record == nullptr) throw std::out_of_range("SlamMap: no such keyframe");
  return *record;
}

Pose SlamMap::pose_of(KeyframeId id) const {
  Pose keyframe_from_camera = Pose::Identity();
  const KeyframeRecord* r = &record(id);
  for (; r->anchor != kNoId; r = &record(r->anchor))
    keyframe_from_camera = r->anchor_from_camera * keyframe_from_camera;
  return keyframes_.find(r->id)->map_from_camera * keyframe_from_camera;
}

void SlamMap::set_pose(KeyframeId id, const Pose& map_from_camera) {
  if (Keyframe* k = keyframes_.find(id)) {
    k->map_from_camera = map_from_camera;
  } else if (KeyframeRecord* r = records_.find(id)) {
    r->anchor_from_camera = pose_of(r->anchor).inverse() * map_from_camera;
  }
}

std::vector<KeyframePose> SlamMap::keyframe_poses(KeyframeId first) const {
  std::vector<KeyframePose> poses;
  records_.for_each_from(first, [&](const KeyframeRecord& r) {
    poses.push_back({r.id, r.stamp_ns, pose_of(r.id)});
  });
  return poses;
}

}  // namespace rds::tracker
