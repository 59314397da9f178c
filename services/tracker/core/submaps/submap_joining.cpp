// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/submaps/submap_joining.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "services/tracker/core/loops/loop_drift.hpp"

namespace rds::tracker {
namespace {

constexpr std::size_t kNewest = 6;
constexpr double kMaxDifferenceM = 0.10;  // as of loops: a place is found to a few centimetres
constexpr double kMaxDifferenceRad = 0.05;

/// Moves the later keyframe's submap to where it lies in the earlier one's.
Pose earlier_from_later_submap(const SlamMap& map, const LoopMatch& seen) {
  return map.pose_of(seen.earlier) * seen.earlier_from_later * map.pose_of(seen.later).inverse();
}

bool is_of_same_submaps(const Submaps& submaps, const LoopMatch& a, const LoopMatch& b) {
  return submaps.of(a.later) == submaps.of(b.later) && submaps.of(a.earlier) == submaps.of(b.earlier);
}

}  // namespace

bool are_one(const Pose& a, const Pose& b) {
  const Pose difference = a.inverse() * b;
  return difference.translation().norm() <= kMaxDifferenceM &&
         geometry::rotation_angle_rad(difference.linear()) <= kMaxDifferenceRad;
}

bool agree(const SlamMap& map, const LoopMatch& newest, const LoopMatch& before) {
  if (!is_of_same_submaps(map.records().submaps(), newest, before)) return false;
  const Pose by_newest = map.pose_of(newest.earlier) * newest.earlier_from_later;
  const Pose by_before = earlier_from_later_submap(map, before) * map.pose_of(newest.later);
  return are_one(by_newest, by_before);
}

std::vector<FoundKeyframe> SubmapSightings::add(const SlamMap& map, const FoundKeyframe& seen) {
  std::erase_if(seen_, [&](const FoundKeyframe& s) {  // not all poses are kept for ever
    return !map.records().contains(s.match.later) || !map.records().contains(s.match.earlier);
  });
  std::vector<FoundKeyframe> agreeing;
  std::ranges::copy_if(seen_, std::back_inserter(agreeing),
                       [&](const FoundKeyframe& before) { return agree(map, seen.match, before.match); });
  agreeing.push_back(seen);
  seen_.push_back(seen);
  if (seen_.size() > kNewest) seen_.pop_front();
  if (agreeing.size() < kAgreeingSightings) agreeing.clear();
  return agreeing;
}

bool are_confirmed(const SlamMap& map, std::span<const FoundKeyframe> sightings) {
  std::vector<LoopMatch> by_features;
  std::vector<LoopMatch> by_votes;
  for (const FoundKeyframe& s : sightings) (s.by_votes ? by_votes : by_features).push_back(s.match);
  if (!by_features.empty() && confirms(map, by_features)) return true;
  if (by_votes.size() < kAgreeingSightings) return false;
  const auto drift = drift_of(map, by_votes.back());
  return drift && drift->log_odds() >= 0;
}

SubmapMove move_of(const SlamMap& map, const LoopMatch& seen) {
  const SubmapId later = map.records().submaps().of(seen.later);
  const SubmapId earlier = map.records().submaps().of(seen.earlier);
  const Pose earlier_from_later = earlier_from_later_submap(map, seen);
  return earlier < later ? SubmapMove{later, earlier, earlier_from_later}
                         : SubmapMove{earlier, later, earlier_from_later.inverse()};
}

/// Poses of culled keyframes are relative to others of their submap, and move with these.
void move_submap(SlamMap& map, const SubmapMove& move) {
  Submaps& submaps = map.records().submaps();
  map.keyframes().for_each([&](Keyframe& k) {
    if (submaps.of(k.id) == move.moved) k.map_from_camera = move.into_from_moved * k.map_from_camera;
  });
  std::vector<PointId> moved;
  std::as_const(map).points().for_each([&](const MapPoint& p) {
    if (submaps.of(p.created_by) == move.moved) moved.push_back(p.id);
  });
  for (const PointId id : moved) {
    MapPoint& point = *map.point(id);
    point.position = move.into_from_moved * point.position;
    update_view(map, point);
  }
  submaps.join(move.moved, move.into);
}

}  // namespace rds::tracker
