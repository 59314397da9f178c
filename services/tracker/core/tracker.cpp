// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/core/tracker.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "services/tracker/core/pose/pose_optimization.hpp"

namespace rds::tracker {
namespace {

// The camera's pose has moved by less than a depth sensor's noise 2 m away.
constexpr double kSamePlaceM = 0.01;
constexpr double kSamePlaceRad = 0.005;

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

void describe(const TrackedFrame& frame, FrameResult& result) {
  result.features = static_cast<unsigned>(frame.features->size());
  result.dynamic_features =
      static_cast<unsigned>(std::ranges::count_if(frame.features->all(), &Feature::movable));
  result.verdicts = verdicts(frame);
  if (has_pose(result.state)) result.inliers = static_cast<unsigned>(frame.matches());
}

}  // namespace

Tracker::Tracker(const TrackerConfig& config, TrackerPorts ports)
    : config_(config),
      ports_(std::move(ports)),
      calibration_(config.self_calibration),
      removal_(config.removal, config.depth),
      odometry_(ports_.given_poses ? RobotOdometry() : ports_.odometry),
      gyroscope_(ports_.given_poses ? Gyroscope() : ports_.gyroscope),
      localizer_(config, ports_.executor, ports_.now_us, ports_.given_poses != nullptr),
      keyframes_(config.keyframe),
      mapper_(localizer_.settings(), !config.localize_only, config.keep_all_poses) {}

void Tracker::reset() {
  *this = Tracker(config_, std::move(ports_));
}

/// The paper's figure 1, "Tracking": prediction and removal of what moves, pose, keyframe decision.
FrameResult Tracker::track(const image::RgbdFrame& given,
                           std::span<const segmentation::ObjectRegion> regions) {
  FrameResult result;
  result.state = state_ == State::kNotInitialized ? State::kNotInitialized : State::kLost;
  localizer_.relocalizer().index_pending(mapper_.map());
  keyframes_.begin_frame();
  if (!is_usable(given)) return result;

  image::RgbdFrame picture = given;
  picture.camera = calibration_.calibrated(given.camera);
  const std::int64_t started_us = ports_.now_us();
  TrackingContext context{
      mapper_.map(), localizer_.settings(), picture, ObservationModel(picture.camera), {}, {}};
  prepare(given, regions, context);
  PoseEstimate estimate = localizer_.localize(context, state_, keyframes_);
  TrackedFrame& frame = estimate.frame;
  if (estimate.state == State::kLost && is_submap_due(frame.time_ns))
    result.begins_submap = localizer_.begin_submap(context, estimate);
  const bool is_carried = estimate.state == State::kLost && context.carried;
  result.state = state_ = estimate.state;
  if (is_carried) carry_on(*context.carried, frame, result);
  if (has_pose(state_)) {
    const Submaps& submaps = mapper_.map().records().submaps();
    enter(result.begins_submap ? submaps.next() : submaps.of(localizer_.features().reference()));
  }

  KeyframeNeed need = KeyframeNeed::kNone;
  if (estimate.begins_map) {
    make_keyframe(KeyframeNeed::kMap, frame, result);
  } else if (state_ == State::kTracking || state_ == State::kRelocalised) {
    const KeyframeSelector::Candidate candidate{context, frame, localizer_.features().reference(),
                                                localizer_.scene_changed()};
    need =
        estimate.is_followed ? keyframes_.need_of_followed(candidate) : keyframes_.need_of_matched(candidate);
    if (need == KeyframeNeed::kMap && estimate.is_followed && !localizer_.match_features(context, estimate))
      need = KeyframeNeed::kNone;
  }
  describe(frame, result);
  result.map_covariance = drift_.under(mapper_.map(), frame.points, frame.camera_from_map.inverse());
  if (need != KeyframeNeed::kNone) make_keyframe(need, frame, result);
  if (has_pose(result.state)) {
    result.map_from_camera = frame.camera_from_map.inverse();
    result.information = frame.information;
    result.reference_keyframe_id = localizer_.features().reference();
    result.submap = submap_;
    result.reference_from_camera =
        mapper_.map().pose_of(result.reference_keyframe_id).inverse() * result.map_from_camera;
  }
  result.movable = context.movable;
  result.up = estimate.up;
  finish(context, std::move(frame));
  result.times = {estimate.extract_us, ports_.now_us() - started_us - estimate.extract_us};
  return result;
}

/// Fills in what is known before the pose is looked for: time, motion, a guess of the pose, the local map,
/// what is movable, and the points that were found beside.
void Tracker::prepare(const image::RgbdFrame& given, std::span<const segmentation::ObjectRegion> regions,
                      TrackingContext& context) {
  const auto [time_ns, went_back] = time_.go_to(given.stamp_ns);
  if (went_back) {  // the camera may be anywhere, and what moved before moves no more
    removal_.forget();
    localizer_.depth_aligner().forget();
    motion_.forget_velocity();
    if (state_ != State::kNotInitialized) state_ = State::kLost;
  }
  context.motion = motion_.predict(last_map_from_camera(), time_ns);
  expect_by_gyroscope(given.stamp_ns, context);
  expect_by_odometry(given.stamp_ns, context);
  TrackedFrame& frame = context.frame;
  frame.stamp_ns = given.stamp_ns;
  frame.time_ns = time_ns;
  frame.given_fx = calibration_.given_fx();
  frame.motion = {context.motion.velocity(), calibration_.readout_s()};
  if (ports_.given_poses)
    if (const auto map_from_camera = ports_.given_poses(given.stamp_ns))
      context.guess = map_from_camera->inverse();
  run_both(
      ports_.executor, [&] { localizer_.guess(context, state_); },
      [&] {
        removal_.set_picture(given);
        localizer_.select_local_map(context);
      });
  std::atomic<bool> is_cut = false;
  const auto cut = [&] {
    std::vector<Eigen::Vector3f> stable;
    if (context.guess) removal_.detect_motion(*context.guess);
    if (context.guess && config_.removal.method == "depth")
      stable = stable_points(context.map, context.local.points, *context.guess);
    context.movable = removal_.segment(regions, stable);
    is_cut = true;
  };
  run_both(ports_.executor, cut, [&] { localizer_.search_early(context, state_, is_cut); });
  context.depth = {&removal_.grid(), removal_.latest().depth_m, removal_.latest_mask()};
  frame.movable_in_view = context.movable.any() || !regions.empty();
  frame.camera_from_map =
      context.alignment.value_or(context.guess.value_or(context.motion.camera_from_map()));
}

/// @param need  kDetector: for other services; of it the map keeps the pose at most.
void Tracker::make_keyframe(KeyframeNeed need, TrackedFrame& frame, FrameResult& result) {
  KeyframeRecords& records = mapper_.map().records();
  records.submaps().go_on(submap_, records.next_id());
  if (need == KeyframeNeed::kMap) {
    result.keyframe =
        mapper_.insert(frame, localizer_.follows_points() ? frame.images : nullptr, removal_.latest());
    if (!frame.information.isZero())  // else its pose is given, or what the map begins with
      drift_.add(result.keyframe->id, result.map_covariance + pose_covariance(frame.information));
    localizer_.features().set_newest_keyframe(result.keyframe->id);
    localizer_.relocalizer().add(result.keyframe->id);
    keyframes_.note_in_map(result.keyframe->id, frame.time_ns);
    if (const auto culled = mapper_.cull_temporary()) localizer_.relocalizer().remove(*culled);
  } else {
    const KeyframePose keyframe = mapper_.insert_pose_only(frame, localizer_.features().reference());
    result.keyframe = KeyframeData{keyframe.id, keyframe.stamp_ns, keyframe.map_from_camera, {}, {}, false};
    keyframes_.note_not_in_map(frame.time_ns);
  }
  localizer_.begin_interval();
}

/// What the frame tells those that come.
void Tracker::finish(const TrackingContext& context, TrackedFrame&& frame) {
  const bool waits_for_light = context.carried && !localizer_.can_begin_map(frame);
  if (has_pose(state_) || waits_for_light)
    lost_since_ns_.reset();
  else if (state_ == State::kLost && !lost_since_ns_)
    lost_since_ns_ = frame.time_ns;
  if (!has_pose(state_)) return localizer_.depth_aligner().forget();
  const Pose map_from_camera = frame.camera_from_map.inverse();
  removal_.set_pose(map_from_camera, !frame.by_depth_only);
  localizer_.depth_aligner().set_previous(context.depth, map_from_camera);
  motion_.observe(context.motion, frame.camera_from_map, state_ != State::kRelocalised);
  if (state_ == State::kTracking && !frame.by_depth_only)
    gyroscope_.observe(Eigen::Quaterniond(context.motion.last_map_from_camera().linear().transpose() *
                                          map_from_camera.linear()));
  else
    gyroscope_.begin_window();
  if (frame.by_depth_only) return;  // later frames are still matched with the one before
  motion_.start_from(frame.time_ns);
  compare_with_odometry(map_from_camera);
  const KeyframeId reference = localizer_.features().reference();
  const Pose reference_from_camera = mapper_.map().pose_of(reference).inverse() * map_from_camera;
  localizer_.features().set_last({std::move(frame), reference, reference_from_camera});
}

Pose Tracker::last_map_from_camera() const {
  const std::optional<LastFrame>& last = localizer_.features().last();
  return last ? mapper_.map().pose_of(last->reference) * last->reference_from_camera : Pose::Identity();
}

Pose Tracker::expected_camera_from_map(std::int64_t stamp_ns) const {
  if (ports_.given_poses)
    if (const auto given = ports_.given_poses(stamp_ns)) return given->inverse();
  return motion_.predict(last_map_from_camera(), time_.at(stamp_ns).time_ns).camera_from_map();
}

std::optional<LocalMappingJob> Tracker::take_mapping_job() {
  localizer_.relocalizer().index_pending(mapper_.map());
  return mapper_.take_job(calibration_);
}

void Tracker::move_picture(KeyframeId id, const Picture& before, Picture now) {
  Keyframe* keyframe = mapper_.map().keyframe(id);
  if (keyframe != nullptr && keyframe->images == before) keyframe->images = std::move(now);
}

void Tracker::apply(const LocalMappingResult& result) {
  localizer_.relocalizer().index_pending(mapper_.map());
  const auto culled = mapper_.apply(result);
  if (!culled) return;
  if (mapper_.is_mostly_static(result.keyframe)) calibration_.update(result.keyframe, result.imaging);
  for (const KeyframeId keyframe : *culled) localizer_.relocalizer().remove(keyframe);
}

bool Tracker::correct(std::span<const KeyframePose> corrected, std::span<const LoopMatch> loops) {
  if (ports_.given_poses) return true;
  const Pose before = last_map_from_camera();
  const auto replaced = mapper_.correct(corrected, loops);
  if (!replaced) return false;
  localizer_.features().replace_points(*replaced);
  forget_depth_where_moved(before);
  return true;
}

std::optional<LocalMappingJob> Tracker::take_adjustment_job() {
  return mapper_.take_adjustment(calibration_);
}

bool Tracker::apply_adjustment(const LocalMappingResult& result) {
  const Pose before = last_map_from_camera();
  if (!mapper_.apply_adjustment(result)) return false;
  forget_depth_where_moved(before);
  return true;
}

void Tracker::forget_depth() {
  removal_.forget();
  localizer_.depth_aligner().forget();
}

/// Depth pictures of before stand where the camera was then.
void Tracker::forget_depth_where_moved(const Pose& last_before) {
  const Pose moved = last_before.inverse() * last_map_from_camera();
  if (moved.translation().norm() < kSamePlaceM &&
      geometry::rotation_angle_rad(moved.linear()) < kSamePlaceRad)
    return;
  forget_depth();
}

void Tracker::retract_movable(std::uint64_t keyframe_id,
                              std::span<const segmentation::ObjectRegion> regions) {
  if (const segmentation::PictureCells* cells = mapper_.cells_of(keyframe_id))
    mapper_.retract(keyframe_id, removal_.segment_keyframe(*cells, regions));
}

}  // namespace rds::tracker
