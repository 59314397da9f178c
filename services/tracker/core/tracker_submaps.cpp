// SPDX-License-Identifier: Apache-2.0
// The part of Tracker that gives up young maps, and begins and joins submaps.
#include <algorithm>
#include <utility>

#include "services/tracker/core/submaps/submap_search.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr double kLostForGoodS = 1;  // at least, before a young map is given up

}  // namespace

/// How long the map was tracked in; nullopt of one that is not to be given up.
std::optional<double> Tracker::tracked_s() const {
  const Keyframe* first = mapper_.map().keyframe(0);
  const std::optional<LastFrame>& last = localizer_.features().last();
  const bool is_own =
      mapper_.map().records().first_free() == 0 && !config_.localize_only && !ports_.given_poses;
  if (!is_own || first == nullptr || !last) return std::nullopt;
  return static_cast<double>(last->frame.time_ns - first->time_ns) / kNsPerSecond;
}

double Tracker::lost_s(std::int64_t time_ns) const {
  return lost_since_ns_ ? static_cast<double>(time_ns - *lost_since_ns_) / kNsPerSecond : 0;
}

bool Tracker::has_lost_young_map(std::int64_t stamp_ns) const {
  const auto tracked = tracked_s();
  return tracked && *tracked < config_.young_map_s &&
         lost_s(time_.at(stamp_ns).time_ns) > std::max(kLostForGoodS, *tracked);
}

/// Not while the map may be given up, nor where the camera has not found itself yet in a map of before. Where
/// poses are given it is never lost, but without a pose.
bool Tracker::is_submap_due(std::int64_t time_ns) const {
  const auto tracked = tracked_s();
  const bool is_young = tracked && *tracked < config_.young_map_s;
  return config_.submap_after_s > 0 && !is_young && !ports_.given_poses && localizer_.features().last() &&
         lost_s(time_ns) >= config_.submap_after_s;
}

/// Depth pictures of another submap stand in another frame.
void Tracker::enter(SubmapId submap) {
  if (std::exchange(submap_, submap) != submap) forget_depth();
}

std::optional<JoinedSubmap> Tracker::join_submaps() {
  SlamMap& map = mapper_.map();
  const KeyframeId newest = keyframes_.newest_in_map();
  if (map.records().submaps().is_whole() || std::exchange(searched_, newest) == newest) return std::nullopt;
  localizer_.relocalizer().index_pending(map);
  auto seen = localizer_.relocalizer().find_in_others(map, localizer_.settings(), newest);
  if (!seen) seen = find_around_loss(map, newest);
  if (!seen) return std::nullopt;
  const auto agreeing = sightings_.add(map, *seen);
  if (agreeing.empty()) return std::nullopt;
  const Pose before = last_map_from_camera();
  const SubmapMove move = move_of(map, seen->match);
  JoinedSubmap joined{move.moved, {}};
  if (move.into == Submaps::kMap)
    std::as_const(map).keyframes().for_each([&](const Keyframe& k) {
      if (map.records().submaps().of(k.id) == move.moved) joined.placed.push_back(k.id);
    });
  const auto replaced = mapper_.join(move, agreeing);
  if (!replaced) return std::nullopt;
  sightings_.clear();
  submap_ = map.records().submaps().of(localizer_.features().reference());
  localizer_.features().replace_points(*replaced);
  forget_depth_where_moved(before);
  return joined;
}

}  // namespace rds::tracker
