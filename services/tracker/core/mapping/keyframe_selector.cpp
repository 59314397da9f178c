// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/mapping/keyframe_selector.hpp"

#include <algorithm>
#include <bitset>
#include <vector>

namespace rds::tracker {
namespace {

constexpr double kMaxInnovation = 4;      // of a frame that enters the map with fewer than kSureInliers
constexpr std::size_t kWellObserved = 2;  // keyframes, of a point that the reference keyframe can rely on
constexpr int kCells = 20;                // of the picture's width and height, for its covered part

double seconds(std::int64_t duration_ns) {
  constexpr double kNsPerSecond = 1e9;
  return static_cast<double>(duration_ns) / kNsPerSecond;
}

/// Cells of the picture in which the frame sees map points.
int covered_cells(const TrackedFrame& frame) {
  const geometry::CameraModel& camera = frame.features->camera();
  std::bitset<kCells * kCells> covered;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    if (frame.points[i] == kNoId) continue;
    const Eigen::Vector2f& px = (*frame.features)[i].image_px;
    const auto column = static_cast<std::size_t>(px.x() / static_cast<float>(camera.width) * kCells);
    const auto row = static_cast<std::size_t>(px.y() / static_cast<float>(camera.height) * kCells);
    if (column < kCells && row < kCells) covered.set(row * kCells + column);
  }
  return static_cast<int>(covered.count());
}

int well_observed_points(const SlamMap& map, const Keyframe& keyframe) {
  const std::size_t wanted = map.keyframes().size() > 2 ? kWellObserved : 1;
  return static_cast<int>(std::ranges::count_if(keyframe.points, [&](PointId id) {
    const MapPoint* point = map.point(id);
    return point != nullptr && point->observations.size() >= wanted;
  }));
}

/// Of what the camera measures; where it measures nothing, of the map points that the frame sees.
double median_depth(const SlamMap& map, const TrackedFrame& frame) {
  std::vector<float> depths;
  for (const Feature& f : frame.features->all())
    if (f.depth_m > 0 && !f.movable) depths.push_back(f.depth_m);
  if (depths.empty())
    for (const PointId id : frame.points)
      if (const MapPoint* point = map.point(id))
        depths.push_back(static_cast<float>((frame.camera_from_map * point->position).z()));
  if (depths.empty()) return 2;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return static_cast<double>(*middle);
}

/// How well the map serves the frame.
void add_facts_of_map(const KeyframeSelector::Candidate& candidate, KeyframeFacts& facts) {
  const auto& [context, frame, reference_id, scene_changed] = candidate;
  const Keyframe* reference = context.map.keyframe(reference_id);
  if (reference != nullptr) facts.seen_by_reference = well_observed_points(context.map, *reference);
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const Feature& f = (*frame.features)[i];
    if (f.movable || f.depth_m <= 0 || static_cast<double>(f.depth_m) > context.settings.depth.close_depth_m)
      continue;
    ++(frame.points[i] != kNoId ? facts.close_tracked : facts.close_new);
  }
}

}  // namespace

KeyframeSelector::NearestView KeyframeSelector::nearest_view(const SlamMap& map, const TrackedFrame& frame,
                                                             KeyframeId reference_id) const {
  const double depth = median_depth(map, frame);
  NearestView nearest;
  const auto compare = [&](KeyframeId id, const Pose& map_from_camera) {
    const double change = view_change(frame.camera_from_map * map_from_camera, depth);
    if (change < nearest.change) nearest = {id, change};
  };
  const auto compare_old = [&](KeyframeId id) {
    const Keyframe* keyframe = map.keyframe(id);
    if (keyframe != nullptr && seconds(frame.time_ns - keyframe->time_ns) > config_.known_after_s)
      compare(id, keyframe->map_from_camera);
  };
  const Submaps& submaps = map.records().submaps();
  const Keyframe* newest = map.keyframe(newest_in_map_);
  if (newest != nullptr && submaps.of(newest->id) == submaps.of(reference_id))
    compare(newest->id, newest->map_from_camera);
  compare_old(reference_id);
  if (const Keyframe* reference = map.keyframe(reference_id))
    for (const CovisibleKeyframe& c : reference->covisible) compare_old(c.id);
  return nearest;
}

KeyframeFacts KeyframeSelector::facts(const Candidate& candidate, double view_change) const {
  const TrackedFrame& frame = candidate.frame;
  KeyframeFacts facts;
  facts.inliers = facts.seen = frame.matches();
  facts.has_depth = frame.features->has_depth();
  facts.triangulates = candidate.context.settings.depth.triangulate;
  add_facts_of_map(candidate, facts);
  facts.view_change = view_change;
  facts.since_last_s = seconds(frame.time_ns - *last_ns_);
  facts.frames_since_last = frames_since_last_;
  if (const Keyframe* newest = candidate.context.map.keyframe(newest_in_map_))
    facts.since_map_s = seconds(frame.time_ns - newest->time_ns);
  facts.movable_or_changed = frame.movable_in_view || candidate.scene_changed;
  return facts;
}

KeyframeNeed KeyframeSelector::need_of_matched(const Candidate& candidate) const {
  const auto& [context, frame, reference, scene_changed] = candidate;
  if (!frame.pose_is_given) {
    if (frame.static_matches() < kMinInliers) return KeyframeNeed::kNone;
    const bool may_follow_a_mover = frame.movable_in_view && frame.matches() < kSureInliers;
    if (may_follow_a_mover && context.motion.innovation(frame.camera_from_map) > kMaxInnovation)
      return KeyframeNeed::kNone;
  }
  if (!last_ns_) return frame.features->has_depth() ? KeyframeNeed::kMap : KeyframeNeed::kNone;
  return keyframe_need(facts(candidate, nearest_view(context.map, frame, reference).change), config_);
}

KeyframeNeed KeyframeSelector::need_of_followed(const Candidate& candidate) {
  if (!last_ns_) return KeyframeNeed::kNone;
  const NearestView view = nearest_view(candidate.context.map, candidate.frame, candidate.reference);
  const int covered = covered_cells(candidate.frame);
  if (view.keyframe != followed_view_) covered_at_view_ = covered;
  followed_view_ = view.keyframe;
  KeyframeFacts facts = this->facts(candidate, view.change);
  facts.seen = covered;
  facts.seen_by_reference = covered_at_view_;
  return keyframe_need(facts, config_);
}

void KeyframeSelector::note_in_map(KeyframeId keyframe, std::int64_t time_ns) {
  newest_in_map_ = keyframe;
  followed_view_ = kNoId;
  note_not_in_map(time_ns);
}

void KeyframeSelector::note_not_in_map(std::int64_t time_ns) {
  last_ns_ = time_ns;
  frames_since_last_ = 0;
}

}  // namespace rds::tracker
