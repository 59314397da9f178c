// SPDX-License-Identifier: Apache-2.0
// The part of Tracker that builds and changes the map.
#include <algorithm>
#include <utility>

#include "services/tracker/core/mapping/map_building.hpp"
#include "services/tracker/core/mapping/mapping_exchange.hpp"
#include "services/tracker/core/relocalization/relocalization.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {
namespace {

constexpr double kWild = 4;           // jerk() of a frame that is no keyframe of the map, with few inliers
constexpr std::size_t kShown = 1000;  // keyframes that are remembered where the map does not grow
constexpr std::size_t kAwaitingBoxes = 30;  // keyframes whose boxes may still come
constexpr std::size_t kWellObserved = 2;    // keyframes, of a point that the reference keyframe can rely on

double seconds(std::int64_t duration_ns) {
  constexpr double kNsPerSecond = 1e9;
  return static_cast<double>(duration_ns) / kNsPerSecond;
}

int well_observed_points(const SlamMap& map, const Keyframe& keyframe) {
  const std::size_t wanted = map.keyframes() > 2 ? kWellObserved : 1;
  return static_cast<int>(std::ranges::count_if(keyframe.points, [&](PointId id) {
    const MapPoint* point = map.point(id);
    return point != nullptr && point->observations.size() >= wanted;
  }));
}

bool has_depth(const FeatureSet& features) {
  return std::ranges::any_of(features.all(), [](const Feature& f) { return f.depth_m > 0; });
}

double median_depth(const FeatureSet& features) {
  std::vector<float> depths;
  for (const Feature& f : features.all())
    if (f.depth_m > 0 && !f.movable) depths.push_back(f.depth_m);
  if (depths.empty()) return 2;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  return static_cast<double>(*middle);
}

KeyframeData keyframe_data(const SlamMap& map, const Keyframe& keyframe) {
  KeyframeData data;
  data.id = keyframe.id;
  data.stamp_ns = keyframe.stamp_ns;
  data.map_from_camera = keyframe.map_from_camera;
  data.features.reserve(keyframe.points.size());
  for (std::size_t i = 0; i < keyframe.points.size(); ++i)
    data.features.push_back(
        {(*keyframe.features)[i], keyframe.features->point_in_camera(i).cast<float>(),
         keyframe.points[i] == kNoId ? -1 : static_cast<std::int64_t>(keyframe.points[i])});
  for (const CovisibleKeyframe& c : keyframe.covisible)
    data.covisible.push_back({c.id, c.weight, map.pose_of(c.id)});
  return data;
}

}  // namespace

std::vector<KeyframePose> Tracker::keyframe_poses() const {
  if (config_.localize_only) return {shown_.begin(), shown_.end()};
  return map_.keyframe_poses(map_.first_free_keyframe());
}

/// How well the map serves the frame; left out where it cannot be made better.
void Tracker::add_facts_of_map(const TrackedFrame& frame, KeyframeFacts& facts) const {
  const Keyframe* reference = map_.keyframe(reference_);
  if (reference != nullptr) facts.seen_by_reference = well_observed_points(map_, *reference);
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const Feature& f = (*frame.features)[i];
    if (f.movable || f.depth_m <= 0 || static_cast<double>(f.depth_m) > config_.depth.close_depth_m) continue;
    ++(frame.points[i] != kNoId ? facts.close_tracked : facts.close_new);
  }
}

/// The keyframe with the view nearest to the frame's, and how far that is: the newest one, or one of those
/// around that have been there for long. (While a place is new, every turn of the camera makes a keyframe:
/// from views that come back bundle adjustment learns what drifted and how rows are read.) Where the map does
/// not grow, it is the last one shown.
Tracker::KnownView Tracker::nearest_view(const TrackedFrame& frame) const {
  const double depth = median_depth(*frame.features);
  KnownView nearest;
  const auto look_at = [&](KeyframeId id, const Pose& map_from_camera) {
    const double change = view_change(frame.camera_from_map * map_from_camera, depth, config_.keyframe);
    if (change < nearest.change) nearest = {id, change};
  };
  if (config_.localize_only) {
    if (!shown_.empty()) look_at(shown_.back().id, shown_.back().map_from_camera);
    return nearest;
  }
  const auto look_at_old = [&](KeyframeId id) {
    const Keyframe* keyframe = map_.keyframe(id);
    if (keyframe != nullptr && seconds(frame.time_ns - keyframe->time_ns) > config_.keyframe.known_after_s)
      look_at(id, keyframe->map_from_camera);
  };
  if (const Keyframe* newest = map_.keyframe(newest_keyframe_)) look_at(newest->id, newest->map_from_camera);
  look_at_old(reference_);
  if (const Keyframe* reference = map_.keyframe(reference_))
    for (const CovisibleKeyframe& c : reference->covisible) look_at_old(c.id);
  return nearest;
}

KeyframeFacts Tracker::keyframe_facts(const TrackedFrame& frame, double view_change) const {
  KeyframeFacts facts;
  facts.inliers = facts.seen = frame.matches();
  facts.has_depth = has_depth(*frame.features);
  if (!config_.localize_only) add_facts_of_map(frame, facts);
  facts.view_change = view_change;
  facts.since_last_s = seconds(frame.time_ns - *last_keyframe_ns_);
  facts.frames_since_last = frames_since_keyframe_;
  facts.movable_or_changed = frame.movable_there || changed_;
  return facts;
}

KeyframeNeed Tracker::keyframe_need(const TrackedFrame& frame) const {
  const bool well_localized = state_ != State::kWeak && frame.static_matches() >= config_.quality.min_inliers;
  if (!well_localized && !frame.pose_is_given) return KeyframeNeed::kNone;
  if (frame.movable_there && frame.matches() < kSureInliers && jerk(frame) > kWild)
    return KeyframeNeed::kNone;
  if (!last_keyframe_ns_) return has_depth(*frame.features) ? KeyframeNeed::kMap : KeyframeNeed::kNone;
  return tracker::keyframe_need(keyframe_facts(frame, nearest_view(frame).change), config_.keyframe);
}

void Tracker::add_keyframe(KeyframeNeed need, TrackedFrame& frame, FrameResult& result) {
  if (need == KeyframeNeed::kLook || config_.localize_only)
    show_keyframe(frame, result);
  else
    make_keyframe(frame, result);
}

/// A keyframe for others to look at; of it the map keeps the pose at most.
void Tracker::show_keyframe(const TrackedFrame& frame, FrameResult& result) {
  KeyframeData& shown = result.keyframe.emplace();
  shown.stamp_ns = frame.stamp_ns;
  shown.map_from_camera = frame.camera_from_map.inverse();
  shown.in_map = false;
  if (config_.localize_only) {
    shown.id = map_.next_keyframe_id() + shown_count_++;
    shown_.push_back({shown.id, shown.stamp_ns, shown.map_from_camera});
    if (shown_.size() > kShown && config_.map.pose_only_s > 0) shown_.pop_front();
  } else {
    shown.id = map_.add_passing(shown.stamp_ns, shown.map_from_camera, reference_);
    if (mapping_centre_ == kNoId) mapping_centre_ = reference_;  // nothing new: what is there gets better
  }
  last_keyframe_ns_ = frame.time_ns;
  frames_since_keyframe_ = 0;
  changed_ = false;
}

void Tracker::make_keyframe(TrackedFrame& frame, FrameResult& result) {
  const PointId first_new = map_.next_point_id();
  const Keyframe& keyframe = insert_keyframe(map_, frame, config_.depth, config_.map);
  frame.points = keyframe.points;  // the next frame looks for the new points too
  if (follows_points()) map_.keyframe(keyframe.id)->images = images_;
  newest_keyframe_ = reference_ = keyframe.id;
  last_keyframe_ns_ = frame.time_ns;
  frames_since_keyframe_ = 0;
  followed_view_ = kNoId;
  changed_ = false;
  result.keyframe = keyframe_data(map_, keyframe);
  unindexed_ = keyframe.id;
  for (PointId id = first_new; id < map_.next_point_id(); ++id) recent_points_.push_back(id);
  cull_recent_points(map_, keyframe.id, config_.map, recent_points_);
  mapping_centre_ = keyframe.id;
  depth_of_keyframes_.push_back({keyframe.id, cut_.latest()});
  if (depth_of_keyframes_.size() > kAwaitingBoxes) depth_of_keyframes_.pop_front();
}

/// Makes the newest keyframe a place that a lost camera can find itself by.
void Tracker::index_newest_keyframe() {
  if (const Keyframe* keyframe = map_.keyframe(std::exchange(unindexed_, kNoId)))
    places_.add(keyframe->id, static_descriptors(*keyframe->features));
}

void Tracker::index_all_keyframes() {
  std::as_const(map_).all_keyframes().for_each(
      [this](const Keyframe& k) { places_.add(k.id, static_descriptors(*k.features)); });
}

std::optional<LocalMappingJob> Tracker::take_mapping_job() {
  index_newest_keyframe();
  const KeyframeId centre = std::exchange(mapping_centre_, kNoId);
  if (map_.keyframe(centre) == nullptr) return std::nullopt;  // none is due, or it was culled
  LocalMappingJob job = make_mapping_job(map_, centre, config_.local_mapping);
  job.revision = revision_;
  job.readout_s = calibration_.readout_s();
  job.focal_scale = calibration_.focal_scale();
  job.given_fx = given_fx_;
  job.pyramid = pyramid_;
  job.depth = config_.depth;
  job.robust = config_.pose;
  job.fusion_max_distance = config_.matching.max_distance_strict;
  return job;
}

/// A keyframe that nobody has learned from, at least half of whose features show what stands still.
bool Tracker::teaches_calibration(KeyframeId id) const {
  const Keyframe* keyframe = map_.keyframe(id);
  const bool is_new = calibrated_with_ == kNoId || id > calibrated_with_;
  return is_new && keyframe != nullptr &&
         2 * std::ranges::count(keyframe->movable, true) <= std::ssize(keyframe->movable);
}

void Tracker::apply(const LocalMappingResult& result) {
  if (result.revision != revision_) return;
  index_newest_keyframe();
  apply_mapping_result(map_, result);
  if (teaches_calibration(result.keyframe)) {
    calibration_.update(result.imaging);
    calibrated_with_ = result.keyframe;
  }
  for (const KeyframeId culled : cull_redundant_keyframes(map_, result.keyframe, config_.depth, config_.map))
    places_.remove(culled);
}

void Tracker::apply(const PoseGraphCorrection& correction) {
  if (given_poses_) return;
  apply_correction(map_, correction.poses);
  cut_.forget();
  ++revision_;
}

void Tracker::retract_movable(std::uint64_t keyframe_id, std::span<const MovableRegion> regions) {
  const PointId first_new = map_.next_point_id();
  const auto depth = std::ranges::find(depth_of_keyframes_, keyframe_id, &KeyframeDepth::keyframe);
  if (depth == depth_of_keyframes_.end()) return;
  tracker::retract_movable(map_, keyframe_id, cut_.cut_late(depth->cells, regions), config_.depth,
                           config_.map);
  for (PointId id = first_new; id < map_.next_point_id(); ++id) recent_points_.push_back(id);
}

}  // namespace rds::tracker
