// SPDX-License-Identifier: Apache-2.0
// The part of Tracker that builds and changes the map.
#include <algorithm>

#include "services/tracker/core/map_building.hpp"
#include "services/tracker/core/mapping_exchange.hpp"
#include "services/tracker/core/relocalization.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr std::size_t kWellObserved = 2;  // keyframes, of a point that the reference keyframe can rely on

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

std::optional<KeyframePose> Tracker::newest_keyframe() const {
  if (!shown_.empty()) return shown_.back();
  if (newest_keyframe_ == kNoId) return std::nullopt;
  return KeyframePose{newest_keyframe_, map_.keyframe_stamp_ns(newest_keyframe_),
                      map_.pose_of(newest_keyframe_)};
}

std::vector<KeyframePose> Tracker::keyframe_poses() const {
  return config_.localize_only ? shown_ : map_.keyframe_poses(map_.first_free_keyframe());
}

/// How well the map serves the frame; left out where it cannot be made better.
void Tracker::add_facts_of_map(const TrackedFrame& frame, KeyframeFacts& facts) const {
  const Keyframe* reference = map_.keyframe(reference_);
  if (reference != nullptr) facts.reference_points = well_observed_points(map_, *reference);
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const Feature& f = (*frame.features)[i];
    if (f.movable || f.depth_m <= 0 || static_cast<double>(f.depth_m) > config_.depth.close_depth_m) continue;
    ++(frame.points[i] != kNoId ? facts.close_tracked : facts.close_new);
  }
}

KeyframeFacts Tracker::keyframe_facts(const TrackedFrame& frame, const KeyframePose& newest,
                                      bool movable_there, int inliers) const {
  KeyframeFacts facts;
  facts.inliers = inliers;
  facts.has_depth = has_depth(*frame.features);
  if (!config_.localize_only) add_facts_of_map(frame, facts);
  const Pose moved = frame.camera_from_map * newest.map_from_camera;
  facts.rotation_rad = geometry::rotation_angle_rad(moved.linear());
  facts.translation_m = moved.translation().norm();
  facts.median_depth_m = median_depth(*frame.features);
  facts.since_last_s = static_cast<double>(frame.stamp_ns - newest.stamp_ns) / kNsPerSecond;
  facts.movable_or_changed = movable_there || changed_;
  return facts;
}

bool Tracker::needs_keyframe(const TrackedFrame& frame, bool movable_there) const {
  const bool well_localized = state_ != State::kWeak && frame.static_matches() >= config_.quality.min_inliers;
  if (!well_localized && !frame.pose_is_given) return false;
  const auto newest = newest_keyframe();
  if (!newest) return has_depth(*frame.features);
  return is_keyframe(keyframe_facts(frame, *newest, movable_there, frame.matches()), config_.keyframe);
}

void Tracker::add_keyframe(TrackedFrame& frame, FrameResult& result) {
  if (config_.localize_only)
    show_keyframe(frame, result);
  else
    make_keyframe(frame, result);
}

/// A keyframe for others to look at; the map does not learn of it.
void Tracker::show_keyframe(const TrackedFrame& frame, FrameResult& result) {
  result.keyframe.emplace();
  result.keyframe->id = map_.next_keyframe_id() + shown_.size();
  result.keyframe->stamp_ns = frame.stamp_ns;
  result.keyframe->map_from_camera = frame.camera_from_map.inverse();
  result.keyframe->in_map = false;
  shown_.push_back({result.keyframe->id, frame.stamp_ns, result.keyframe->map_from_camera});
  changed_ = false;
}

void Tracker::make_keyframe(TrackedFrame& frame, FrameResult& result) {
  const PointId first_new = map_.next_point_id();
  const Keyframe& keyframe = insert_keyframe(map_, frame, config_.depth, config_.map);
  frame.points = keyframe.points;  // the next frame looks for the new points too
  if (follows_points()) map_.keyframe(keyframe.id)->images = images_;
  newest_keyframe_ = reference_ = keyframe.id;
  covered_at_keyframe_ = 0;
  changed_ = false;
  result.keyframe = keyframe_data(map_, keyframe);
  places_.add(keyframe.id, static_descriptors(*frame.features));
  for (PointId id = first_new; id < map_.next_point_id(); ++id) recent_points_.push_back(id);
  cull_recent_points(map_, keyframe.id, config_.map, recent_points_);
  job_due_ = true;
}

std::optional<LocalMappingJob> Tracker::take_mapping_job() {
  if (!job_due_) return std::nullopt;
  job_due_ = false;
  LocalMappingJob job = make_mapping_job(map_, newest_keyframe_, config_.local_mapping);
  job.revision = revision_;
  job.readout_s = readout_.readout_s();
  job.calibrate_readout = config_.rolling_shutter.calibrate;
  job.pyramid = pyramid_;
  job.depth = config_.depth;
  job.robust = config_.pose;
  job.fusion_max_distance = config_.matching.max_distance_strict;
  return job;
}

void Tracker::apply(const LocalMappingResult& result) {
  if (result.revision != revision_) return;
  apply_mapping_result(map_, result);
  readout_.update(result.readout_s, result.readout_information);
  for (const KeyframeId culled : cull_redundant_keyframes(map_, result.keyframe, config_.depth, config_.map))
    places_.remove(culled);
}

void Tracker::apply(const PoseGraphCorrection& correction) {
  if (given_poses_) return;
  apply_correction(map_, correction.poses);
  ++revision_;
}

void Tracker::retract_movable(std::uint64_t keyframe_id, std::span<const MovableRegion> regions) {
  const PointId first_new = map_.next_point_id();
  tracker::retract_movable(map_, keyframe_id, regions, config_.depth, config_.map);
  for (PointId id = first_new; id < map_.next_point_id(); ++id) recent_points_.push_back(id);
}

}  // namespace rds::tracker
