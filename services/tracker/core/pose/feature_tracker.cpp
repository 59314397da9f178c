// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/pose/feature_tracker.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace rds::tracker {
namespace {

constexpr double kMaxBridgedGap = 2;    // s; beyond, the last frame says nothing about where the camera is
constexpr int kEnoughMatches = 20;      // of a frame, before optimisation
constexpr int kEnoughInliers = 10;      // after it
constexpr double kMotionWindowPx = 15;  // around where the motion model expects a feature, at level 0
constexpr double kWideWindow = 4;       // times the motion window, when velocity failed
constexpr double kAdoptedWindowPx = 2;  // between a followed point and the corner that is taken for it

}  // namespace

void FeatureTracker::extract(const TrackingContext& context, TrackedFrame& frame) {
  std::vector<Feature> features;
  MovableTest is_movable;
  if (context.movable.any())
    is_movable = [&](const Eigen::Vector2f& px) { return context.movable.covers(px); };
  extractor_->extract(context.frame.images->level(0), is_movable, features);
  frame.features = complete_feature_set(context, std::move(features));
  frame.clear_matches();
}

int FeatureTracker::track(const TrackingContext& context, TrackedFrame& frame) {
  if (context.motion.gap_s() > kMaxBridgedGap) return 0;
  int inliers = 0;
  if (estimate_from_last_frame(context, frame)) inliers = refine(context, frame, kUsualWindow);
  if (inliers >= kSureInliers) return inliers;
  TrackedFrame second = frame;
  const KeyframeId reference = reference_;
  if (estimate_from_keyframe(context, second)) {
    const int again = refine(context, second, kLostWindow);
    if (again > inliers) {
      frame = std::move(second);
      return again;
    }
  }
  reference_ = reference;
  return inliers;
}

bool FeatureTracker::estimate_from_last_frame(const TrackingContext& context, TrackedFrame& frame) const {
  const Pose aligned = frame.camera_from_map;
  const Pose& predicted = context.motion.camera_from_map();
  const Pose still = context.motion.last_map_from_camera().inverse();
  for (const auto& [guess, window_px] : {std::pair{predicted, kMotionWindowPx},
                                         {aligned, kMotionWindowPx},
                                         {predicted, 2 * kMotionWindowPx},
                                         {still, kWideWindow * kMotionWindowPx}}) {
    frame.camera_from_map = guess;
    if (match_last_frame(context.map, last_->frame, context.model, context.settings.pyramid, window_px,
                         frame) < kEnoughMatches)
      continue;
    if (optimize(context, frame) >= kEnoughInliers) return true;
  }
  return false;
}

bool FeatureTracker::estimate_from_keyframe(const TrackingContext& context, TrackedFrame& frame) const {
  for (const KeyframeId id : {reference_, newest_keyframe_}) {
    const Keyframe* keyframe = context.map.keyframe(id);
    if (keyframe == nullptr) continue;
    frame.camera_from_map = context.motion.last_map_from_camera().inverse();
    if (match_keyframe(context.map, *keyframe, frame) < kMinKeyframeMatches) continue;
    if (optimize(context, frame) >= kEnoughInliers) return true;
  }
  return false;
}

int FeatureTracker::refine(const TrackingContext& context, TrackedFrame& frame, double window_factor) {
  const LocalMap local = select_local_map(context.map, frame.points, ++mark_);
  if (local.reference == kNoId) return 0;
  for (const PointId id : frame.points)
    if (MapPoint* point = context.map.point(id)) ++point->visible;
  const int seen = frame.matches();
  const PointMatches more =
      match_points(context.map, local.points, context.model, context.settings.pyramid, window_factor, frame);
  const int inliers = optimize(context, frame);
  count_found_points(context.map, frame);
  frame.found_share = found_share_.update(seen + more.expected, inliers);
  reference_ = local.reference;
  return inliers;
}

void FeatureTracker::associate(const TrackingContext& context, TrackedFrame& frame) {
  const Keyframe* reference = context.map.keyframe(reference_);
  if (last_)
    match_last_frame(context.map, last_->frame, context.model, context.settings.pyramid, kMotionWindowPx,
                     frame);
  else if (reference != nullptr)
    match_keyframe(context.map, *reference, frame);
  optimize(context, frame);
  refine(context, frame, kUsualWindow);
}

LocalMap FeatureTracker::local_map_of_last(const TrackingContext& context) {
  if (!last_) return {};
  const std::vector<PointId>& seen = last_->frame.points;
  LocalMap around = select_local_map(context.map, seen, ++mark_);
  LocalMap all{std::move(around.keyframes), {}, around.reference};
  std::ranges::copy_if(seen, std::back_inserter(all.points),
                       [&](PointId id) { return std::as_const(context.map).point(id) != nullptr; });
  all.points.insert(all.points.end(), around.points.begin(), around.points.end());
  return all;
}

LocalMap FeatureTracker::local_map_around(const TrackingContext& context) const {
  const Keyframe* reference = std::as_const(context.map).keyframe(reference_);
  if (reference == nullptr) return {};
  std::vector<PointId> seen = reference->points;
  for (const CovisibleKeyframe& c : reference->covisible)
    std::ranges::copy(std::as_const(context.map).keyframe(c.id)->points, std::back_inserter(seen));
  std::erase(seen, kNoId);
  std::ranges::sort(seen);
  seen.erase(std::ranges::unique(seen).begin(), seen.end());
  return {{}, std::move(seen), reference_};
}

void FeatureTracker::replace_points(const std::map<PointId, PointId>& replaced) {
  if (!last_) return;
  for (PointId& point : last_->frame.points)
    for (auto next = replaced.find(point); next != replaced.end(); next = replaced.find(point))
      point = next->second;
}

void adopt_followed_points(const TrackingContext& context, const TrackedFrame& followed,
                           TrackedFrame& frame) {
  std::vector<Feature> features = frame.features->all();
  for (std::size_t i = 0; i < followed.points.size(); ++i) {
    if (followed.points[i] == kNoId) continue;
    const Feature& f = (*followed.features)[i];
    const SearchWindow window{f.px,
                              static_cast<float>(kAdoptedWindowPx * context.settings.pyramid.scale(f.level)),
                              f.level - 1, f.level + 1, 0};
    const auto corner = best_in_window(*frame.features, frame.points, context.model, f.descriptor, window,
                                       kMaxDistanceNearby, 1);
    if (!corner) continue;
    frame.points[*corner] = followed.points[i];
    features[*corner].px = f.px;
    features[*corner].image_px = f.image_px;
    features[*corner].depth_m = f.depth_m;
  }
  frame.features = std::make_shared<const FeatureSet>(context.picture.camera, std::move(features));
}

}  // namespace rds::tracker
