// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/tracker.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>

#include "services/tracker/core/relocalization/relocalization.hpp"

namespace rds::tracker {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLastingObservers = 3;  // keyframes and …
constexpr std::uint32_t kLastingFound = 8;    // frames that saw a point that lasts

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

Tracker::Tracker(const TrackerConfig& config, GivenPoses given_poses, RunParts run_parts)
    : config_(config),
      given_poses_(std::move(given_poses)),
      run_parts_(std::move(run_parts)),
      pyramid_(config.extraction.levels, config.extraction.scale_factor),
      extractor_(config.extraction, run_parts_),
      cut_(config.removal, config.depth.max_depth_m),
      map_(config.map, pyramid_),
      calibration_(config.self_calibration) {}

void Tracker::reset() {
  *this = Tracker(config_, std::move(given_poses_), std::move(run_parts_));
}

void Tracker::start_from(SavedMap&& saved) {
  reset();
  map_ = std::move(saved.map);
  if (map_.keyframes() == 0) return;
  given_fx_ = saved.camera.given_fx;
  calibration_.begin_with_focal_scale(saved.camera.focal_scale);
  map_.all_keyframes().for_each([&](Keyframe& k) { k.time_ns = clock_.go_to(k.stamp_ns).time_ns; });
  index_all_keyframes();
  state_ = State::kLost;
}

void Tracker::extract(const image::RgbdFrame& picture, const MovableMask& movable, TrackedFrame& frame,
                      FrameResult& result) {
  const auto start = Clock::now();
  std::vector<Feature> features;
  features.reserve(static_cast<std::size_t>(config_.extraction.features));
  MovableTest is_movable;
  if (movable.any()) is_movable = [&](const Eigen::Vector2f& px) { return movable.covers(px); };
  extractor_.extract(images_->level(0), is_movable, features);
  frame.motion = shutter_motion(frame.time_ns);
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
  if (given.camera.fx != given_fx_) calibration_ = SelfCalibration(config_.self_calibration);  // another one
  given_fx_ = given.camera.fx;
  image::RgbdFrame picture = given;
  picture.camera.fx *= calibration_.focal_scale();
  picture.camera.fy *= calibration_.focal_scale();
  return picture;
}

/// Where the camera is by the last frame's points or by the motion model; unknown where neither says
/// anything. Points that something moving has taken along are told by where they would have the camera.
void Tracker::guess_pose(const image::RgbdFrame& picture, Surroundings& around) const {
  if (given_poses_) {
    if (const auto given = given_poses_(picture.stamp_ns)) around.camera_from_map = given->inverse();
    return;
  }
  if (!last_ || !has_pose(state_)) return;
  around.camera_from_map = expected_at(time_ns_);
  if (!follows_points()) return;
  const Pose aligned = align_with_last(picture);
  if (last_->frame.movable_there && jerk(aligned, time_ns_) > 1)
    around.aligned = aligned;
  else
    around.camera_from_map = aligned;
}

/// The points that the frame should see, if it is where the last one was.
void Tracker::look_around(Surroundings& around) {
  if (!last_ || !(follows_points() || removes_by_depth())) return;
  const LocalMap local = select_local_map(map_, last_->frame.points, config_.map, ++mark_);
  around.reference = local.reference;
  std::ranges::copy_if(last_->frame.points, std::back_inserter(around.points),
                       [&](PointId id) { return map_.point(id) != nullptr; });
  around.points.insert(around.points.end(), local.points.begin(), local.points.end());
}

/// Those of the points around, in the camera frame, that have been found where they are for long.
std::vector<Eigen::Vector3f> Tracker::lasting_points(const Surroundings& around) const {
  std::vector<Eigen::Vector3f> lasting;
  if (!removes_by_depth() || !around.camera_from_map) return lasting;
  for (const PointId id : around.points) {
    const MapPoint& point = *map_.point(id);
    if (point.observations.size() < kLastingObservers || point.found < kLastingFound ||
        2 * point.found < point.visible)
      continue;
    lasting.push_back((*around.camera_from_map * point.position).cast<float>());
  }
  return lasting;
}

/// Gets ready what a picture is searched with for points, and for what is movable.
void Tracker::look(const image::RgbdFrame& given, const image::RgbdFrame& picture, Surroundings& around) {
  run_both(
      run_parts_,
      [&] {
        look_at(picture);
        guess_pose(picture, around);
      },
      [&] {
        cut_.look_at(given);
        look_around(around);
      });
}

/// Where they can be followed, the points around are looked for beside.
MovableMask Tracker::cut_movable(const image::RgbdFrame& picture, std::span<const MovableRegion> regions,
                                 Surroundings& around) {
  MovableMask movable;
  std::atomic<bool> is_cut = false;
  const auto cut = [&] {
    if (around.camera_from_map) cut_.compare(*around.camera_from_map);
    movable = cut_.cut(regions, lasting_points(around));
    is_cut = true;
  };
  run_both(run_parts_, cut, [&] {
    if (!can_follow(around)) return;
    around.search.emplace(search_around(picture, around, *around.camera_from_map));
    around.search->look_ahead(is_cut);
  });
  return movable;
}

FrameResult Tracker::track(const image::RgbdFrame& given, std::span<const MovableRegion> regions) {
  FrameResult result;
  result.state = state_ == State::kNotInitialized ? State::kNotInitialized : State::kLost;
  index_newest_keyframe();
  ++frames_since_keyframe_;
  if (!is_usable(given)) return result;
  const image::RgbdFrame picture = calibrated(given);
  const auto start = Clock::now();
  go_to(picture.stamp_ns);
  Surroundings around;
  look(given, picture, around);
  const MovableMask movable = cut_movable(picture, regions, around);
  TrackedFrame frame;
  frame.stamp_ns = picture.stamp_ns;
  frame.time_ns = time_ns_;
  frame.given_fx = given_fx_;
  frame.movable_there = movable.any() || !regions.empty();
  const Pose guess = around.camera_from_map.value_or(expected_at(time_ns_));
  frame.camera_from_map = around.aligned.value_or(guess);
  const KeyframeNeed need = find_pose(picture, around, movable, frame, result);
  result.state = state_;
  result.features = static_cast<unsigned>(frame.features->size());
  result.dynamic_features =
      static_cast<unsigned>(std::ranges::count_if(frame.features->all(), &Feature::movable));
  result.verdicts = verdicts(frame);
  if (has_pose(state_)) {
    result.inliers = static_cast<unsigned>(frame.matches());
    if (need != KeyframeNeed::kNone) add_keyframe(need, frame, result);
    result.map_from_camera = frame.camera_from_map.inverse();
    result.reference_keyframe_id = reference_;
    result.reference_from_camera = map_.pose_of(reference_).inverse() * result.map_from_camera;
  }
  result.movable = movable;
  remember(std::move(frame), state_);
  result.times.track_us = microseconds_since(start) - result.times.extract_us;
  return result;
}

/// Where stamps have gone back, the camera may be anywhere, and what moved before moves no more.
void Tracker::go_to(std::int64_t stamp_ns) {
  const auto [time_ns, went_back] = clock_.go_to(stamp_ns);
  time_ns_ = time_ns;
  if (!went_back) return;
  cut_.forget();
  velocity_.reset();
  if (state_ != State::kNotInitialized) state_ = State::kLost;
}

void Tracker::look_at(const image::RgbdFrame& picture) {
  cv::Mat gray;
  picture.color.to_gray(gray);
  images_ =
      std::make_shared<const ImagePyramid>(gray, follows_points() ? config_.following.coarsest_level + 1 : 1);
}

/// Extracts features and finds the pose from them. @return what else the frame is to become.
KeyframeNeed Tracker::track_features(const image::RgbdFrame& picture, const MovableMask& movable,
                                     TrackedFrame& frame, FrameResult& result) {
  extract(picture, movable, frame, result);
  if (given_poses_)
    follow(frame, result);
  else if (state_ == State::kNotInitialized)
    initialize(frame, result);
  else
    state_ = track_motion(frame);
  if (!has_pose(state_) || result.keyframe) return KeyframeNeed::kNone;
  return keyframe_need(frame);
}

void Tracker::initialize(TrackedFrame& frame, FrameResult& result) {
  const auto with_depth = std::ranges::count_if(frame.features->all(),
                                                [](const Feature& f) { return f.depth_m > 0 && !f.movable; });
  if (config_.localize_only || with_depth < config_.quality.min_features_to_start) return;
  frame.camera_from_map = Pose::Identity();
  state_ = State::kTracking;
  make_keyframe(frame, result);
}

}  // namespace rds::tracker
