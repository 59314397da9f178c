// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/tracker.hpp"

#include <algorithm>
#include <chrono>

#include "services/tracker/core/local_map.hpp"
#include "services/tracker/core/relocalization.hpp"
#include "services/tracker/core/se3.hpp"

namespace rds::tracker {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kNsPerSecond = 1e9;
constexpr double kMaxPredictedGap = 0.5;  // s; beyond, constant velocity is a guess
constexpr int kEnoughMatches = 20;        // of a frame, before optimisation
constexpr int kEnoughInliers = 10;        // after it
constexpr double kWideWindow = 4;         // times the motion window, when velocity failed

std::int64_t microseconds_since(Clock::time_point start) {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start).count();
}

bool is_usable(const image::RgbdFrame& frame) {
  const cv::Size size(frame.camera.width, frame.camera.height);
  const int depth_type = frame.depth.values.type();
  return frame.camera.is_valid() && frame.color.pixels.type() == CV_8UC3 &&
         frame.color.pixels.size() == size && frame.depth.values.size() == size &&
         (depth_type == CV_16UC1 || depth_type == CV_32FC1) && frame.depth.metres_per_unit > 0;
}

double newest_focal_length(const SlamMap& map) {
  double fx = 0;
  map.all_keyframes().for_each([&](const Keyframe& k) { fx = k.features->camera().fx; });
  return fx;
}

std::vector<KeypointVerdict> verdicts(const TrackedFrame& frame) {
  std::vector<KeypointVerdict> all;
  all.reserve(frame.features->size());
  for (std::size_t i = 0; i < frame.features->size(); ++i) {
    const Feature& f = (*frame.features)[i];
    const auto use = f.movable                  ? KeypointVerdict::Use::kDynamic
                     : frame.points[i] != kNoId ? KeypointVerdict::Use::kUsed
                                                : KeypointVerdict::Use::kUnused;
    all.push_back({f.image_px, use});
  }
  return all;
}

}  // namespace

Tracker::Tracker(const TrackerConfig& config, GivenPoses given_poses)
    : config_(config),
      given_poses_(std::move(given_poses)),
      pyramid_(config.extraction.levels, config.extraction.scale_factor),
      extractor_(config.extraction),
      map_(config.map, pyramid_),
      calibration_(config.self_calibration),
      change_(config.keyframe.changed_share),
      change_while_following_(config.keyframe.changed_share) {}

void Tracker::reset() {
  *this = Tracker(config_, std::move(given_poses_));
}

void Tracker::start_from(SlamMap&& map) {
  reset();
  map_ = std::move(map);
  if (map_.keyframes() == 0) return;
  map_.all_keyframes().for_each(
      [&](const Keyframe& k) { places_.add(k.id, static_descriptors(*k.features)); });
  state_ = State::kLost;
}

void Tracker::extract(const image::RgbdFrame& picture, std::span<const MovableRegion> movable,
                      TrackedFrame& frame, FrameResult& result) {
  const auto start = Clock::now();
  std::vector<Feature> features;
  features.reserve(static_cast<std::size_t>(config_.extraction.features));
  OrbExtractor::MovableTest is_movable;
  if (!movable.empty())
    is_movable = [&](const Eigen::Vector2f& px) {
      const float depth = depth_at(picture.depth, px, config_.depth.max_depth_m);
      return std::ranges::any_of(movable, [&](const MovableRegion& r) { return covers(r, px, depth); });
    };
  extractor_.extract(images_->level(0), is_movable, features);
  frame.stamp_ns = picture.stamp_ns;
  frame.motion = {velocity_.value_or(Twist::Zero()), calibration_.readout_s()};
  set_features(picture, std::move(features), frame);
  frame.clear_matches();
  result.times.extract_us = microseconds_since(start);
}

/// Gives features what the camera model and the depth picture know of them.
void Tracker::set_features(const image::RgbdFrame& picture, std::vector<Feature>&& features,
                           TrackedFrame& frame) const {
  complete_features(picture.camera, picture.depth, config_.depth.max_depth_m, features);
  remove_rolling_shutter(picture.camera, frame.motion, features);
  frame.features = std::make_shared<const FeatureSet>(picture.camera, std::move(features));
}

/// The picture (its pixels shared) with the focal length that is known by now.
image::RgbdFrame Tracker::calibrated(const image::RgbdFrame& given) {
  if (given_fx_ == 0 && map_.keyframes() > 0)
    calibration_.begin_with_focal_scale(newest_focal_length(map_) / given.camera.fx);
  given_fx_ = given.camera.fx;
  image::RgbdFrame picture = given;
  picture.camera.fx *= calibration_.focal_scale();
  picture.camera.fy *= calibration_.focal_scale();
  return picture;
}

FrameResult Tracker::track(const image::RgbdFrame& given, std::span<const MovableRegion> movable) {
  FrameResult result;
  result.state = state_ == State::kNotInitialized ? State::kNotInitialized : State::kLost;
  if (!is_usable(given)) return result;
  const image::RgbdFrame picture = calibrated(given);
  const auto start = Clock::now();
  look_at(picture);
  TrackedFrame frame;
  const KeyframeNeed need = follow_map(picture, movable, frame)
                                ? follow_with_keyframe(picture, movable, frame, result)
                                : track_features(picture, movable, frame, result);
  result.state = state_;
  result.features = static_cast<unsigned>(frame.features->size());
  result.dynamic_features =
      static_cast<unsigned>(std::ranges::count_if(frame.features->all(), &Feature::movable));
  if (has_pose(state_)) {
    result.inliers = static_cast<unsigned>(frame.matches());
    if (need != KeyframeNeed::kNone) add_keyframe(need, frame, result);
    result.map_from_camera = frame.camera_from_map.inverse();
    result.reference_keyframe_id = reference_;
    result.reference_from_camera = map_.pose_of(reference_).inverse() * result.map_from_camera;
  }
  result.verdicts = verdicts(frame);
  remember(std::move(frame), state_);
  result.times.track_us = microseconds_since(start) - result.times.extract_us;
  return result;
}

void Tracker::look_at(const image::RgbdFrame& picture) {
  cv::Mat gray;
  picture.color.to_gray(gray);
  images_ =
      std::make_shared<const ImagePyramid>(gray, follows_points() ? config_.following.coarsest_level + 1 : 1);
}

/// Extracts features and finds the pose from them. @return what else the frame is to become.
KeyframeNeed Tracker::track_features(const image::RgbdFrame& picture, std::span<const MovableRegion> movable,
                                     TrackedFrame& frame, FrameResult& result) {
  extract(picture, movable, frame, result);
  if (given_poses_)
    follow(frame, result);
  else if (state_ == State::kNotInitialized)
    initialize(frame, result);
  else
    state_ = track_motion(frame);
  if (!has_pose(state_) || result.keyframe) return KeyframeNeed::kNone;
  return keyframe_need(frame, !movable.empty());
}

void Tracker::initialize(TrackedFrame& frame, FrameResult& result) {
  const auto with_depth = std::ranges::count_if(frame.features->all(),
                                                [](const Feature& f) { return f.depth_m > 0 && !f.movable; });
  if (config_.localize_only || with_depth < config_.quality.min_features_to_start) return;
  frame.camera_from_map = Pose::Identity();
  state_ = State::kTracking;
  make_keyframe(frame, result);
}

Pose Tracker::last_map_from_camera() const {
  return last_ ? map_.pose_of(last_->reference) * last_->reference_from_camera : Pose::Identity();
}

Pose Tracker::expected_camera_from_map(std::int64_t stamp_ns) const {
  if (given_poses_)
    if (const auto given = given_poses_(stamp_ns)) return given->inverse();
  Pose last = last_map_from_camera().inverse();
  if (!velocity_) return last;
  const double gap = static_cast<double>(stamp_ns - last_->frame.stamp_ns) / kNsPerSecond;
  if (gap <= 0 || gap > kMaxPredictedGap) return last;
  return se3_exp(gap * *velocity_) * last;
}

bool Tracker::estimate_from_last_frame(TrackedFrame& frame) {
  const ObservationModel model(frame.features->camera(), config_.depth);
  const Pose predicted = expected_camera_from_map(frame.stamp_ns);
  const Pose still = last_map_from_camera().inverse();
  const double window = config_.matching.motion_window_px;
  for (const auto& [guess, window_px] :
       {std::pair{predicted, window}, {predicted, 2 * window}, {still, kWideWindow * window}}) {
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
  const LocalMap local = select_local_map(map_, frame, config_.map, ++mark_);
  if (local.reference == kNoId) return 0;
  for (const PointId id : frame.points)
    if (MapPoint* point = map_.point(id)) ++point->visible;
  const int seen = frame.matches();
  const PointMatches more =
      match_points(map_, local.points, model, pyramid_, config_.matching, window_factor, frame);
  const int inliers = optimize_frame(map_, model, pyramid_, config_.pose, frame);
  for (const PointId id : frame.points)
    if (MapPoint* point = map_.point(id)) ++point->found;
  changed_ |= change_.update(seen + more.expected, inliers);
  reference_ = local.reference;
  return inliers;
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
  if (!last_) return 0;
  int inliers = 0;
  if (estimate_from_last_frame(frame))
    inliers = refine_with_local_map(frame, config_.matching.map_window_factor);
  if (inliers >= config_.quality.min_inliers) return inliers;
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
  const int inliers = track_from_last(frame);
  if (inliers >= quality.min_inliers) return State::kTracking;
  if (state_ != State::kWeak) weak_since_ns_ = frame.stamp_ns;
  const double weak_s = static_cast<double>(frame.stamp_ns - weak_since_ns_) / kNsPerSecond;
  if (inliers >= quality.min_inliers_weak && weak_s <= quality.weak_s) return State::kWeak;
  return relocalize(frame) ? State::kRelocalised : State::kLost;
}

void Tracker::remember(TrackedFrame&& frame, State state) {
  if (!has_pose(state)) {
    last_.reset();
    velocity_.reset();
    return;
  }
  const Pose map_from_camera = frame.camera_from_map.inverse();
  if (last_ && frame.stamp_ns > last_->frame.stamp_ns) {
    const double gap = static_cast<double>(frame.stamp_ns - last_->frame.stamp_ns) / kNsPerSecond;
    velocity_ = se3_log(frame.camera_from_map * last_map_from_camera()) / gap;
  } else {
    velocity_.reset();
  }
  const Pose reference_from_camera = map_.pose_of(reference_).inverse() * map_from_camera;
  last_ = LastFrame{std::move(frame), images_, reference_, reference_from_camera};
}

}  // namespace rds::tracker
