// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/map_building.hpp"

#include <algorithm>
#include <map>
#include <ranges>
#include <utility>
#include <vector>

#include "services/tracker/core/map/covisibility.hpp"
#include "services/tracker/core/triangulation/triangulated_points.hpp"

namespace rds::tracker {
namespace {

constexpr int kMinPoints = 400;           // the nearest of a keyframe, close or not: as many as are followed
constexpr int kColumns = 10;              // of square parts that a picture is divided into, …
constexpr int kMinPointsInPart = 5;       // … in each of which so many points are wanted
constexpr double kMinFoundRatio = 0.25;   // a point found more rarely where it should show goes
constexpr KeyframeId kKeyframesOn = 2;    // when a point must have been seen again …
constexpr std::size_t kMinObservers = 2;  // … by so many keyframes
constexpr KeyframeId kProbation = 3;      // keyframes after which a point is trusted
constexpr KeyframeId kKeptNewest = 3;     // keyframes that culling leaves alone
constexpr double kRedundantShare = 0.9;   // a keyframe goes when this share of its close points …
constexpr int kRedundantObservers = 3;    // … is seen in so many others
constexpr std::size_t kConsidered = 20;   // covisible keyframes looked at per culling

void observe_matches(SlamMap& map, const TrackedFrame& frame, Keyframe& keyframe) {
  for (std::uint32_t i = 0; i < frame.points.size(); ++i) {
    if (frame.points[i] == kNoId) continue;
    if (map.observe(frame.points[i], keyframe.id, i)) {
      update_from_observations(map, *map.point(frame.points[i]));
      ++keyframe.tracked_points;
    }
  }
}

bool is_close(const Feature& f, const DepthConfig& depth) {
  return f.depth_m > 0 && static_cast<double>(f.depth_m) <= depth.close_depth_m;
}

/// Far ones, too, where the close ones are too few or all in one part of the picture: in a doorway the room
/// behind it is all that the next frames will see, and somebody who comes near hides the close ones at once.
void make_points(SlamMap& map, const DepthConfig& depth, const Keyframe& keyframe) {
  const FeatureSet& features = *keyframe.features;
  std::vector<std::pair<float, std::uint32_t>> by_depth;
  for (std::uint32_t i = 0; i < features.size(); ++i)
    if (features[i].depth_m > 0 && !keyframe.movable[i]) by_depth.emplace_back(features[i].depth_m, i);
  std::ranges::sort(by_depth);
  const float side_px = static_cast<float>(features.camera().width) / kColumns;
  int made = 0;
  std::map<std::pair<int, int>, int> made_in;
  for (const std::uint32_t i : by_depth | std::views::values) {
    const Eigen::Vector2i part = (features[i].image_px / side_px).cast<int>();
    int& made_here = made_in[{part.x(), part.y()}];
    if (!is_close(features[i], depth) && made >= kMinPoints && made_here >= kMinPointsInPart) continue;
    ++made;
    ++made_here;
    if (keyframe.points[i] == kNoId)
      map.add_point(keyframe.map_from_camera * features.point_in_camera(i), keyframe.id, i);
  }
}

/// True if enough other keyframes see the point at the same or a finer scale.
bool seen_by_others(const SlamMap& map, const MapPoint& point, const Keyframe& keyframe, int level) {
  int others = 0;
  for (const Observation& o : point.observations) {
    if (o.keyframe == keyframe.id) continue;
    if ((*map.keyframe(o.keyframe)->features)[o.feature].level <= level + 1 &&
        ++others >= kRedundantObservers)
      return true;
  }
  return false;
}

bool is_redundant(const SlamMap& map, const Keyframe& keyframe, const DepthConfig& depth) {
  int close = 0;
  int redundant = 0;
  const bool has_depth = keyframe.features->has_depth();
  for (std::size_t i = 0; i < keyframe.points.size(); ++i) {
    const Feature& f = (*keyframe.features)[i];
    if (has_depth && !is_close(f, depth)) continue;
    const MapPoint* point = map.point(keyframe.points[i]);
    if (point == nullptr) continue;
    ++close;
    redundant += seen_by_others(map, *point, keyframe, f.level) ? 1 : 0;
  }
  return close > 0 && redundant > kRedundantShare * close;
}

}  // namespace

Keyframe& insert_keyframe(SlamMap& map, const TrackedFrame& frame, const DepthConfig& depth) {
  Keyframe& keyframe = map.add_keyframe(frame.stamp_ns, frame.camera_from_map.inverse(), frame.features);
  keyframe.time_ns = frame.time_ns;
  keyframe.motion = frame.motion;
  keyframe.given_fx = frame.given_fx;
  keyframe.pose_is_given = frame.pose_is_given;
  observe_matches(map, frame, keyframe);
  make_points(map, depth, keyframe);
  update_covisibility(map, keyframe.id);
  return keyframe;
}

void cull_recent_points(SlamMap& map, KeyframeId newest, std::vector<PointId>& recent) {
  std::vector<PointId> undecided;
  for (const PointId id : recent) {
    const MapPoint* point = map.point(id);
    if (point == nullptr) continue;
    const KeyframeId age = newest - point->created_by;
    const bool rarely_found = point->found < kMinFoundRatio * point->visible;
    const bool rarely_observed = age >= kKeyframesOn && point->observations.size() < kMinObservers;
    if (rarely_found || rarely_observed)
      map.erase_point(id);
    else if (age < kProbation)
      undecided.push_back(id);
  }
  recent = std::move(undecided);
}

std::vector<KeyframeId> cull_redundant_keyframes(SlamMap& map, KeyframeId newest, const DepthConfig& depth) {
  const Keyframe* centre = map.keyframe(newest);
  std::vector<KeyframeId> culled;
  if (centre == nullptr) return culled;
  auto around = centre->covisible;
  if (around.size() > kConsidered) around.resize(kConsidered);
  for (const CovisibleKeyframe& c : around) {
    const Keyframe* keyframe = map.keyframe(c.id);
    if (keyframe == nullptr || c.id == 0 || map.records().is_fixed(c.id) || c.id + kKeptNewest > newest)
      continue;
    if (!is_redundant(map, *keyframe, depth)) continue;
    const std::vector<PointId> seen = keyframe->points;
    map.cull_keyframe(c.id);
    for (const PointId id : seen) erase_if_unknown(map, id);
    culled.push_back(c.id);
  }
  return culled;
}

void retract_movable(SlamMap& map, KeyframeId id, const MovableMask& movable, const DepthConfig& depth) {
  Keyframe* keyframe = map.keyframe(id);
  if (keyframe == nullptr || !movable.any()) return;
  for (std::size_t i = 0; i < keyframe->points.size(); ++i) {
    const Feature& f = (*keyframe->features)[i];
    if (!movable.covers(f.image_px)) continue;
    keyframe->movable[i] = true;
    const MapPoint* point = map.point(keyframe->points[i]);
    if (point == nullptr) continue;
    const PointId point_id = point->id;
    if (point->created_by == id || rests_on_views(map, *point))
      map.erase_point(point_id);
    else
      map.forget(point_id, id);
  }
  make_points(map, depth, *keyframe);
}

}  // namespace rds::tracker
