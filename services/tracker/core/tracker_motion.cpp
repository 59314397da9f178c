// SPDX-License-Identifier: Apache-2.0
// The part of Tracker that finds a frame's pose from its features: by motion, by a keyframe, by
// relocalisation.
#include <algorithm>
#include <limits>
#include <numbers>

#include "services/tracker/core/map/local_map.hpp"
#include "services/tracker/core/motion/se3.hpp"
#include "services/tracker/core/relocalization/relocalization.hpp"
#include "services/tracker/core/tracker.hpp"

namespace rds::tracker {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr double kMaxPredictedGap = 0.5;  // s; beyond, constant velocity is a guess
constexpr double kMaxBridgedGap = 2;      // s; beyond, the last frame says nothing about where the camera is
constexpr double kLostForGoodS = 1;       // at least, before a young map is given up
constexpr int kEnoughMatches = 20;        // of a frame, before optimisation
constexpr int kEnoughInliers = 10;        // after it
constexpr double kWideWindow = 4;         // times the motion window, when velocity failed
constexpr double kMaxSpeed = 5;           // m/s and …
constexpr double kPoseNoise = 0.01;       // m and rad
constexpr double kMaxAcceleration = 15;   // m/s² and …
constexpr double kMaxTurnAcceleration = 40;            // rad/s², of a camera in a hand
constexpr double kMaxTurnRate = 2 * std::numbers::pi;  // rad/s, of a camera that is carried or driven

}  // namespace

Pose Tracker::last_map_from_camera() const {
  return last_ ? map_.pose_of(last_->reference) * last_->reference_from_camera : Pose::Identity();
}

Pose Tracker::expected_camera_from_map(std::int64_t stamp_ns) const {
  if (given_poses_)
    if (const auto given = given_poses_(stamp_ns)) return given->inverse();
  return expected_at(clock_.at(stamp_ns).time_ns);
}

/// By the motion model.
Pose Tracker::expected_at(std::int64_t time_ns) const {
  Pose last = last_map_from_camera().inverse();
  const double gap = since_last_s(time_ns);
  if (!velocity_ || gap <= 0 || gap > kMaxPredictedGap) return last;
  return se3_exp(gap * *velocity_) * last;
}

/// Infinite where no frame had a pose yet.
double Tracker::since_last_s(std::int64_t time_ns) const {
  return last_ ? static_cast<double>(time_ns - last_->frame.time_ns) / kNsPerSecond
               : std::numeric_limits<double>::infinity();
}

ShutterMotion Tracker::shutter_motion(std::int64_t time_ns) const {
  const bool known = velocity_ && since_last_s(time_ns) <= kMaxPredictedGap;
  return {known ? *velocity_ : Twist::Zero(), calibration_.readout_s()};
}

/// Mean velocity since the last frame with a pose; nullopt where that is too long ago.
std::optional<Twist> Tracker::motion_to(const TrackedFrame& frame) const {
  const double gap = since_last_s(frame.time_ns);
  if (gap <= 0 || gap > kMaxPredictedGap) return std::nullopt;
  return Twist(se3_log(frame.camera_from_map * last_map_from_camera()) / gap);
}

/// True where no camera can have moved from the last pose to this one.
bool Tracker::has_jumped(const TrackedFrame& frame) const {
  const auto motion = motion_to(frame);
  return motion && (motion->head<3>().norm() > kMaxSpeed || motion->tail<3>().norm() > kMaxTurnRate);
}

/// How far the pose is from where the camera was expected; above 1 no hand accelerates it so: what moves in
/// the picture may have been taken for standing still.
double Tracker::jerk(const Pose& camera_from_map, std::int64_t time_ns) const {
  const double gap = since_last_s(time_ns);
  if (given_poses_ || gap <= 0 || gap > kMaxPredictedGap) return 0;
  const Twist error = se3_log(camera_from_map * expected_at(time_ns).inverse());
  return std::max(error.head<3>().norm() / (kPoseNoise + kMaxAcceleration * gap * gap / 2),
                  error.tail<3>().norm() / (kPoseNoise + kMaxTurnAcceleration * gap * gap / 2));
}

double Tracker::jerk(const TrackedFrame& frame) const {
  return jerk(frame.camera_from_map, frame.time_ns);
}

bool Tracker::has_lost_young_map(std::int64_t stamp_ns) const {
  const Keyframe* first = map_.keyframe(0);
  const bool is_own = map_.first_free_keyframe() == 0 && !config_.localize_only && !given_poses_;
  if (!lost_since_ns_ || !is_own || first == nullptr || !last_) return false;
  const double tracked_s = static_cast<double>(last_->frame.time_ns - first->time_ns) / kNsPerSecond;
  const double lost_s = static_cast<double>(clock_.at(stamp_ns).time_ns - *lost_since_ns_) / kNsPerSecond;
  return tracked_s < config_.quality.young_map_s && lost_s > std::max(kLostForGoodS, tracked_s);
}

/// By how many points a pose is held, of which one that no hand would give the camera needs more.
double Tracker::support(const TrackedFrame& frame) const {
  return frame.static_matches() / std::max(1.0, jerk(frame));
}

bool Tracker::estimate_from_last_frame(TrackedFrame& frame) {
  const ObservationModel model(frame.features->camera(), config_.depth);
  const Pose aligned = frame.camera_from_map;
  const Pose predicted = expected_at(frame.time_ns);
  const Pose still = last_map_from_camera().inverse();
  const double window = config_.matching.motion_window_px;
  for (const auto& [guess, window_px] : {std::pair{predicted, window},
                                         {aligned, window},
                                         {predicted, 2 * window},
                                         {still, kWideWindow * window}}) {
    frame.camera_from_map = guess;
    if (match_last_frame(map_, last_->frame, model, pyramid_, config_.matching, window_px, frame) <
        kEnoughMatches)
      continue;
    if (optimize_frame(map_, model, pyramid_, config_.pose, frame) >= kEnoughInliers) return true;
  }
  return false;
}

bool Tracker::estimate_from_keyframe(TrackedFrame& frame) {
  const ObservationModel model(frame.features->camera(), config_.depth);
  for (const KeyframeId id : {reference_, newest_keyframe_}) {
    const Keyframe* keyframe = map_.keyframe(id);
    if (keyframe == nullptr) continue;
    frame.camera_from_map = last_map_from_camera().inverse();
    if (match_keyframe(map_, *keyframe, config_.matching, frame) < config_.relocalization.min_matches)
      continue;
    if (optimize_frame(map_, model, pyramid_, config_.pose, frame) >= kEnoughInliers) return true;
  }
  return false;
}

int Tracker::refine_with_local_map(TrackedFrame& frame, double window_factor) {
  const ObservationModel model(frame.features->camera(), config_.depth);
  const LocalMap local = select_local_map(map_, frame.points, config_.map, ++mark_);
  if (local.reference == kNoId) return 0;
  for (const PointId id : frame.points)
    if (MapPoint* point = map_.point(id)) ++point->visible;
  const int seen = frame.matches();
  const PointMatches more =
      match_points(map_, local.points, model, pyramid_, config_.matching, window_factor, frame);
  const int inliers = optimize_frame(map_, model, pyramid_, config_.pose, frame);
  count_found(frame);
  note_found(seen + more.expected, inliers, found_by_matching_, frame);
  reference_ = local.reference;
  return inliers;
}

void Tracker::count_found(const TrackedFrame& frame) {
  for (const PointId id : frame.points) {
    MapPoint* point = map_.point(id);
    if (point == nullptr) continue;
    ++point->found;
    point->last_found_ns = frame.time_ns;
  }
}

void Tracker::note_found(int expected, int found, FoundShare& share, TrackedFrame& frame) {
  frame.found_share = share.update(expected, found);
  changed_ |= frame.found_share < 1 - config_.keyframe.changed_share;
}

bool Tracker::relocalize(TrackedFrame& frame) {
  const ObservationModel model(frame.features->camera(), config_.depth);
  const RelocalizationTools tools{model, pyramid_, config_.matching, config_.pose, config_.relocalization};
  const auto candidates = places_.query(static_descriptors(*frame.features),
                                        static_cast<std::size_t>(config_.relocalization.candidates));
  const auto localized = [&](const vision::PlaceCandidate& candidate) {
    return relocalize_against(map_, candidate.id, tools, frame);
  };
  if (std::ranges::none_of(candidates, localized)) return false;
  refine_with_local_map(frame, config_.matching.lost_window_factor);
  return frame.static_matches() >= config_.relocalization.min_inliers;
}

int Tracker::track_from_last(TrackedFrame& frame) {
  if (since_last_s(frame.time_ns) > kMaxBridgedGap) return 0;
  int inliers = 0;
  if (estimate_from_last_frame(frame))
    inliers = refine_with_local_map(frame, config_.matching.map_window_factor);
  if (inliers >= kSureInliers) return inliers;
  TrackedFrame second = frame;
  const KeyframeId reference = reference_;
  if (estimate_from_keyframe(second)) {
    const int again = refine_with_local_map(second, config_.matching.lost_window_factor);
    if (again > inliers) {
      frame = std::move(second);
      return again;
    }
  }
  reference_ = reference;
  return inliers;
}

State Tracker::track_motion(TrackedFrame& frame) {
  const QualityConfig& quality = config_.quality;
  const bool was_lost = state_ == State::kLost;
  const int inliers = track_from_last(frame);
  // Movable objects hide what is expected; then few found points say nothing against the pose.
  const bool sees_enough = frame.movable_there || frame.found_share >= quality.min_found_share;
  if (was_lost && inliers >= config_.relocalization.min_inliers) return State::kRelocalised;
  if (!was_lost && inliers >= quality.min_inliers && sees_enough)
    return has_jumped(frame) ? State::kRelocalised : State::kTracking;
  const auto by_depth = was_lost ? std::nullopt : pose_by_depth(frame.time_ns);
  if (by_depth && find_around(*by_depth, frame)) return State::kTracking;
  if (state_ != State::kWeak) weak_since_ns_ = frame.time_ns;
  const double weak_s = static_cast<double>(frame.time_ns - weak_since_ns_) / kNsPerSecond;
  const bool weak_is_right = !was_lost && !by_depth && weak_s <= quality.weak_s && !has_jumped(frame);
  if (weak_is_right && inliers >= quality.min_inliers_weak) return State::kWeak;
  if (relocalize(frame)) return State::kRelocalised;
  return by_depth ? hold(*by_depth, frame) : State::kLost;
}

void Tracker::remember(TrackedFrame&& frame, State state) {
  if (state == State::kLost && !lost_since_ns_) lost_since_ns_ = frame.time_ns;
  if (!has_pose(state)) return;
  lost_since_ns_.reset();
  cut_.remember(frame.camera_from_map.inverse(), !frame.held_by_depth);
  velocity_ = state == State::kRelocalised ? std::nullopt : motion_to(frame);
  if (frame.held_by_depth) return;  // the last frame is what later ones are matched with
  const Pose reference_from_camera = map_.pose_of(reference_).inverse() * frame.camera_from_map.inverse();
  last_ = LastFrame{std::move(frame), images_, reference_, reference_from_camera};
}

}  // namespace rds::tracker
