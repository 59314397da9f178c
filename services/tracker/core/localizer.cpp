// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/localizer.hpp"

#include <algorithm>
#include <utility>

#include "services/tracker/core/level/level_pose.hpp"
#include "services/tracker/core/level/plane_normals.hpp"
#include "services/tracker/core/pose/sparse_image_alignment.hpp"

namespace rds::tracker {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr int kMinInliersWeak = 15;      // below: lost
constexpr double kMinFoundShare = 0.25;  // of the usual share of expected points found; below: weak
constexpr double kWeakS = 1;             // of weak tracking in a row, then lost
constexpr double kByDepthS = 0.5;        // of tracking by depth alone, then lost
constexpr double kChangedShare = 0.35;   // drop of the share of expected points found that counts as a change
constexpr double kMaxFromDepthM = 0.1;   // between the poses by depth and by points, and …
constexpr double kMaxFromDepthRad = 0.1;

/// Movable objects hide what is expected; then few found points say nothing against the pose.
bool sees_enough(const TrackedFrame& frame) {
  return frame.movable_in_view || frame.found_share >= kMinFoundShare;
}

}  // namespace

Localizer::Localizer(const TrackerConfig& config, const Executor& executor, Stopwatch now_us,
                     bool poses_are_given)
    : config_(config),
      settings_{ScalePyramid(config.extraction.levels, config.extraction.scale_factor), config.depth},
      now_us_(std::move(now_us)),
      poses_are_given_(poses_are_given),
      follows_points_(config.following.enabled && !poses_are_given),
      follower_(config.following.points, executor),
      features_(make_feature_extractor(config.extraction, executor)) {}

void Localizer::guess(TrackingContext& context, State before) const {
  cv::Mat gray;
  context.picture.color.to_gray(gray);
  context.frame.images = std::make_shared<const ImagePyramid>(gray, follows_points_ ? kAlignmentLevels : 1);
  const std::optional<LastFrame>& last = features_.last();
  if (poses_are_given_ || !last || !has_pose(before)) return;
  context.guess = context.motion.camera_from_map();
  if (!follows_points_) return;
  const Pose aligned = follower_.align(context, *last);
  if (last->frame.movable_in_view && context.motion.innovation(aligned) > 1)
    context.alignment = aligned;  // the points may be on something that moves
  else
    context.guess = aligned;
}

void Localizer::select_local_map(TrackingContext& context) {
  if (follows_points_ || config_.removal.method == "depth")
    context.local = features_.local_map_of_last(context);
}

void Localizer::search_early(TrackingContext& context, State before, const std::atomic<bool>& enough) const {
  const bool located = before == State::kTracking || before == State::kRelocalised;
  if (!follows_points_ || !located || !context.guess || context.local.reference == kNoId ||
      !context.map.keyframe(context.local.reference)->images)
    return;
  context.search.emplace(follower_.search(context, *context.guess));
  context.search->prefetch(enough);
}

PoseEstimate Localizer::localize(TrackingContext& context, State before, const KeyframeSelector& keyframes) {
  if (before != State::kLost) sought_.reset();
  auto followed = follower_.estimate(context);
  if (!followed) return match(context, before, keyframes);
  PoseEstimate estimate{std::move(followed->frame), State::kTracking, true, false, nullptr, 0};
  TrackedFrame& frame = estimate.frame;
  follower_.count_found(context.map, followed->expected, frame);
  if (!sees_enough(frame) || context.motion.is_jump(frame.camera_from_map))
    return match(context, before, keyframes);
  features_.set_reference(context.local.reference);
  const double support_of_points = support(frame, context.motion);
  if (!frame.movable_in_view || follower_.is_sure(support_of_points)) return estimate;
  PoseEstimate matched = match(context, before, keyframes);
  if (has_pose(matched.state) && support(matched.frame, context.motion) > support_of_points) return matched;
  features_.set_reference(context.local.reference);
  estimate.extracted = matched.frame.features;
  estimate.extract_us = matched.extract_us;
  return estimate;
}

bool Localizer::can_begin_map(const TrackedFrame& frame) const {
  if (config_.localize_only || !frame.features) return false;
  const auto with_depth = std::ranges::count_if(frame.features->all(),
                                                [](const Feature& f) { return f.depth_m > 0 && !f.movable; });
  return with_depth >= kMinFeaturesToStart;
}

bool Localizer::begin_submap(const TrackingContext& context, PoseEstimate& lost) const {
  if (!can_begin_map(lost.frame)) return false;
  lost.frame.clear_matches();
  begin_map(context, lost);
  lost.state = State::kRelocalised;  // the pose is no continuation of those before
  return true;
}

/// Puts the first camera of a map into it.
void Localizer::begin_map(const TrackingContext& context, PoseEstimate& first) const {
  first.state = State::kTracking;
  first.begins_map = true;
  first.frame.camera_from_map = Pose::Identity();
  const MapFrameConfig& config = config_.map_frame;
  if (!config.level) return;
  if (config.up_in_camera.empty() && measured_up_) {
    first.frame.camera_from_map = level_pose(*measured_up_).inverse();
  } else if (config.up_in_camera.empty()) {
    first.up = find_up(plane_normals(context.depth));
    first.frame.camera_from_map = level_pose(first.up->up).inverse();
  } else {
    const Eigen::Vector3d up(config.up_in_camera[0], config.up_in_camera[1], config.up_in_camera[2]);
    first.frame.camera_from_map = level_pose(up.normalized()).inverse();
  }
}

/// Extracts features and finds the pose from them.
PoseEstimate Localizer::match(const TrackingContext& context, State before,
                              const KeyframeSelector& keyframes) {
  PoseEstimate found{context.frame, before, false, false, nullptr, 0};
  TrackedFrame& frame = found.frame;
  found.extract_us = extract(context, frame);
  if (poses_are_given_) {
    if (!context.guess) {
      if (before != State::kNotInitialized) found.state = State::kLost;
      return found;
    }
    frame.camera_from_map = *context.guess;
    frame.pose_is_given = true;
    found.state = State::kTracking;
    found.begins_map = features_.reference() == kNoId;
    if (!found.begins_map) features_.associate(context, frame);
  } else if (before == State::kNotInitialized) {
    if (!can_begin_map(frame)) return found;
    begin_map(context, found);
  } else {
    found.state = estimate(context, before, keyframes, found);
  }
  return found;
}

/// By the last frame and the keyframes; where that does not do by depth, by relocalisation.
State Localizer::estimate(const TrackingContext& context, State before, const KeyframeSelector& keyframes,
                          PoseEstimate& found) {
  TrackedFrame& frame = found.frame;
  const bool was_lost = before == State::kLost;
  if (was_lost && is_in_unproven_submap(context.map))
    return relocalize(context, frame) ? State::kRelocalised : State::kLost;
  const int inliers = features_.track(context, frame);
  const bool jumped = context.motion.is_jump(frame.camera_from_map);
  if (was_lost && (inliers >= Relocalizer::kMinInliers || find_carried(context, keyframes, frame)))
    return State::kRelocalised;
  if (!was_lost && inliers >= kMinInliers && sees_enough(frame))
    return jumped ? State::kRelocalised : State::kTracking;
  const auto by_depth = was_lost || context.motion.gap_s() > kByDepthS
                            ? std::nullopt
                            : depth_aligner_.estimate(context.depth, context.motion.camera_from_map());
  if (by_depth && find_near(context, *by_depth, keyframes, frame)) return State::kTracking;
  if (before != State::kWeak) weak_since_ns_ = frame.time_ns;
  const double weak_s = static_cast<double>(frame.time_ns - weak_since_ns_) / kNsPerSecond;
  const bool weak_is_right = !was_lost && !by_depth && weak_s <= kWeakS && !jumped;
  if (weak_is_right && inliers >= kMinInliersWeak) return State::kWeak;
  if (follow_expected(context, by_depth.value_or(context.motion.camera_from_map()), found))
    return was_lost ? State::kRelocalised : State::kTracking;
  if (relocalize(context, frame)) return State::kRelocalised;
  if (!by_depth) return State::kLost;
  frame.camera_from_map = *by_depth;
  frame.information.setZero();
  frame.clear_matches();
  frame.by_depth_only = true;
  return State::kWeak;
}

/// Looks for the points of the map around the pose that odometry has carried a lost camera on to.
bool Localizer::find_carried(const TrackingContext& context, const KeyframeSelector& keyframes,
                             TrackedFrame& frame) {
  if (!context.carried || frame.features->size() < std::size_t{Relocalizer::kMinInliers}) return false;
  TrackedFrame found = frame;
  found.camera_from_map = context.carried->map_from_camera.inverse();
  found.clear_matches();
  const auto view = keyframes.nearest_view(context.map, found, features_.reference());
  const Keyframe* keyframe = context.map.keyframe(view.keyframe);
  if (keyframe == nullptr) return false;
  Relocalizer::localize_near(context, *keyframe, found);
  if (found.static_matches() < Relocalizer::kMinInliers) return false;
  frame = std::move(found);
  features_.refine(context, frame, FeatureTracker::kUsualWindow);
  return frame.static_matches() >= Relocalizer::kMinInliers;
}

/// Follows the points of the map from where the camera should be by now. Where a pattern repeats, features
/// are mistaken for each other, and patches that are looked for in their place are not.
bool Localizer::follow_expected(const TrackingContext& context, const Pose& expected, PoseEstimate& lost) {
  if (!follows_points_ || context.motion.gap_s() > kByDepthS) return false;
  TrackingContext around = context;
  around.local = features_.local_map_around(context);
  if (around.local.reference == kNoId) return false;
  auto followed = follower_.follow(around, expected);
  if (!followed) return false;
  follower_.count_found(context.map, followed->expected, followed->frame);
  if (!sees_enough(followed->frame)) return false;
  lost.extracted = lost.frame.features;
  lost.frame = std::move(followed->frame);
  lost.is_followed = true;
  return true;
}

/// Whether the camera is in a submap that is too young for any point to be known to be static: it may be
/// found again by what moves.
bool Localizer::is_in_unproven_submap(const SlamMap& map) const {
  const Keyframe* reference = map.keyframe(features_.reference());
  if (reference == nullptr || map.records().submaps().of(reference->id) == Submaps::kMap) return false;
  return std::ranges::none_of(reference->points, [&](PointId id) {
    const MapPoint* point = map.point(id);
    return point != nullptr && static_weight(map, *point) == 1;
  });
}

bool Localizer::relocalize(const TrackingContext& context, TrackedFrame& frame) {
  const auto around = [this](const Keyframe& k) { return sought_->contains(k.map_from_camera); };
  const Submaps& submaps = context.map.records().submaps();
  const KeyframeId last = features_.reference();
  const bool is_unproven = is_in_unproven_submap(context.map);
  const auto reachable = [&](const Keyframe& k) {
    return last == kNoId || submaps.of(k.id) != submaps.of(last) ||
           (!is_unproven && context.motion.can_be_near(k.map_from_camera));
  };
  const bool is_found = (sought_ && relocalizer_.localize(context, around, frame)) ||
                        relocalizer_.localize(context, reachable, frame);
  if (!is_found) return false;
  features_.refine(context, frame, FeatureTracker::kLostWindow);
  return frame.static_matches() >= Relocalizer::kMinInliers;
}

/// Looks for the points of the map around the pose by depth. @return true if they give the pose.
bool Localizer::find_near(const TrackingContext& context, const Pose& by_depth,
                          const KeyframeSelector& keyframes, TrackedFrame& frame) {
  TrackedFrame found = frame;
  found.camera_from_map = by_depth;
  found.clear_matches();
  const auto view = keyframes.nearest_view(context.map, found, features_.reference());
  const Keyframe* keyframe = context.map.keyframe(view.keyframe);
  if (keyframe == nullptr) return false;
  Relocalizer::localize_near(context, *keyframe, found);
  if (found.static_matches() < kMinInliers) return false;
  const Twist apart = se3_log(found.camera_from_map * by_depth.inverse());
  if (apart.head<3>().norm() > kMaxFromDepthM || apart.tail<3>().norm() > kMaxFromDepthRad) return false;
  frame = std::move(found);
  features_.refine(context, frame, 1);
  return frame.static_matches() >= kMinInliers;
}

bool Localizer::match_features(const TrackingContext& context, PoseEstimate& estimate) {
  const TrackedFrame& followed = estimate.frame;
  TrackedFrame matched = followed;
  matched.features = std::move(estimate.extracted);
  if (matched.features)
    matched.clear_matches();
  else
    estimate.extract_us = extract(context, matched);
  adopt_followed_points(context, followed, matched);
  TrackedFrame at_followed_pose = matched;
  features_.refine(context, matched, 1);
  const auto innovation = [&](const TrackedFrame& f) { return context.motion.innovation(f.camera_from_map); };
  if (followed.movable_in_view && innovation(matched) > std::max(1.0, innovation(followed))) {
    at_followed_pose.pose_is_given = true;  // the refined pose follows something that moves
    features_.refine(context, at_followed_pose, 1);
    matched = std::move(at_followed_pose);
    matched.pose_is_given = false;
  }
  if (matched.static_matches() < kMinInliers) return false;
  estimate.frame = std::move(matched);
  return true;
}

std::int64_t Localizer::extract(const TrackingContext& context, TrackedFrame& frame) {
  const std::int64_t started_us = now_us_();
  features_.extract(context, frame);
  return now_us_() - started_us;
}

bool Localizer::scene_changed() {
  return std::min(follower_.found_share().lowest(), features_.found_share().lowest()) < 1 - kChangedShare;
}

void Localizer::begin_interval() {
  follower_.found_share().begin_interval();
  features_.found_share().begin_interval();
}

}  // namespace rds::tracker
