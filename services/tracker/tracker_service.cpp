// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_service.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/service/checkpoints.hpp"
#include "common/service/possible_poses.hpp"
#include "common/service/random_id.hpp"
#include "services/tracker/pose_file.hpp"
#include "services/tracker/saved_start.hpp"

namespace rds::tracker {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLiveFrames =
    5;  // waiting while one is processed (as the topic keeps); older ones are dropped
constexpr std::size_t kMaxAnswers = 100;
constexpr std::uint8_t kLoop = 1;

std::int64_t now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
}

std::uint32_t microseconds_since(Clock::time_point start) {
  return static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start).count());
}

/// Where nothing enters the map, or poses are given, there is none to find oneself in.
bool keeps_checkpoint(const TrackerServiceConfig& config) {
  return !config.tracker.localize_only && config.poses_file.empty();
}

}  // namespace

TrackerService::TrackerService(service::ServiceContext& context, const TrackerServiceConfig& config)
    : Service(context),
      config_(config),
      map_epoch_(service::random_id()),
      loop_closer_(context.bus),
      tracker_(
          config.tracker, read_given_poses(config.poses_file, config.poses_max_gap_s),
          [this](std::size_t count, const auto& part) { helper_.run(count, part); }, now_us),
      lasting_(
          keeps_checkpoint(config) ? service::open_checkpoints(context, config.maps, "tracker") : nullptr,
          config.maps.checkpoint_s),
      resume_(config.resume_s),
      objects_(config.prediction),
      outputs_(context, map_epoch_),
      input_(context, mailbox_, config.camera,
             config.lockstep.enabled ? std::numeric_limits<std::size_t>::max() : kLiveFrames),
      stamps_(!config.lockstep.enabled),
      boxes_inbox_(mailbox_, kMaxAnswers),
      poses_inbox_(mailbox_, kMaxAnswers),
      mapping_inbox_(mailbox_, 2),
      map_commands_(mailbox_, config.maps, map_file::kTracker),
      mapping_worker_(config.tracker.local_mapping, config.mapping_nice, mapping_inbox_),
      boxes_subscription_(context.bus.subscribe<vision_msgs::msg::Detection3DArray>(
          "rds/boxes", bus::kStream, [this](BoxesMessage m) { boxes_inbox_.push(std::move(m)); })),
      poses_subscription_(context.bus.subscribe<rds_msgs::msg::KeyFramePoses>(
          "rds/keyframe/poses", bus::kLatchedEvery, [this](PosesMessage m) {
            if (m->source() == kLoop && service::is_possible(*m, context_.diagnostics))
              poses_inbox_.push(std::move(m));
          })) {
  if (!config.map_file.empty()) {
    auto [map, checksum] = read_start_or_throw(config);
    start_ = std::move(map);
    start_checksum_ = checksum;
    start_map();
  }
  go_on_from_checkpoint();
  spdlog::info("map epoch {:016x}", map_epoch_);
}

void TrackerService::run(const std::stop_token& stop) {
  stop_ = stop;
  const auto holds_frames = [this] { return paused_ && config_.lockstep.enabled; };  // else they are dropped
  while (wait(stop, [&] {
    return (!holds_frames() && !input_.frames().locked_empty()) || !commands_.locked_empty() ||
           !boxes_inbox_.locked_empty() || !poses_inbox_.locked_empty() || !mapping_inbox_.locked_empty() ||
           map_commands_.locked_ready();
  })) {
    handle_commands();
    map_commands_.settle();
    sort_in_arrivals();
    if (holds_frames()) continue;
    if (const auto frame = input_.frames().try_pop())
      if (!guarded("frame", [&] { take(*frame); })) guarded("frame", [&] { acknowledge(*frame); });
    if (lasting_.is_due()) save_checkpoint();
  }
}

/// Who joins while no frame comes is told all poses, too.
void TrackerService::idle() {
  if (outputs_.has_new_reader()) publish_poses();
}

/// Time is what the stamps of the frames say.
void TrackerService::take(const image::RgbdFrame& frame) {
  const time::StampVerdict verdict = stamps_.take(frame.stamp_ns);
  if (verdict == time::StampVerdict::kBreak) begin_after_break();
  if (verdict == time::StampVerdict::kGap) ++context_.diagnostics.counter("time gaps");
  if (paused_) return;
  const bool in_time = verdict != time::StampVerdict::kDoubt && verdict != time::StampVerdict::kLate;
  in_time ? process(frame) : drop(frame);
}

/// Of another time than the frames before.
void TrackerService::drop(const image::RgbdFrame& frame) {
  ++context_.diagnostics.counter("frames out of time");
  acknowledge(frame);
}

/// A frame that is not tracked: acknowledged without a pose.
void TrackerService::acknowledge(const image::RgbdFrame& frame) {
  FrameResult result;
  if (tracker_.map().keyframes() > 0) result.state = State::kLost;
  outputs_.publish({frame, result, {}, frame_index_, 0, 0, input_.dropped(), box_sets_used_});
  ++frame_index_;
}

/// Where stamps go back, boxes and predictions of before mean nothing: their stamps are of another time.
/// Where they go ahead, these are too old by themselves.
void TrackerService::begin_after_break() {
  ++context_.diagnostics.counter("time breaks");
  spdlog::warn(
      "the camera's stamps go on {:+.3f} s from the last ones: a clock that was set, a recording that "
      "begins again, or a long gap",
      static_cast<double>(stamps_.break_ns()) * 1e-9);
  if (stamps_.break_ns() > 0) return;
  objects_.reset();
  boxes_.clear();
  keyframes_with_boxes_due_.clear();
}

void TrackerService::process(const image::RgbdFrame& frame) {
  if (resume_.is_looking() && frame.camera.is_valid() &&
      frame.camera.fx != tracker_.calibration().given_fx()) {
    spdlog::warn("the map of the checkpoint was made with another camera");
    reset();
  }
  if (config_.lockstep.enabled) await_answers();
  const auto started = Clock::now();
  apply_answers();
  const auto predict_started = Clock::now();
  const auto regions =
      objects_.regions(frame.stamp_ns, tracker_.expected_camera_from_map(frame.stamp_ns), frame.camera);
  std::uint32_t predict_us = microseconds_since(predict_started);
  const FrameResult result = tracker_.track(frame, regions);
  const auto project_started = Clock::now();
  const auto objects = objects_.in_image(frame.stamp_ns, result.map_from_camera.inverse(), frame.camera);
  predict_us += microseconds_since(project_started);
  const std::uint32_t total_us = microseconds_since(started);
  if (result.keyframe) ask_for_answers(*result.keyframe, frame.camera);
  outputs_.publish(
      {frame, result, objects, frame_index_, predict_us, total_us, input_.dropped(), box_sets_used_});
  if (result.keyframe) publish_poses();
  if (result.keyframe) lasting_.schedule().note_keyframe();
  start_mapping();
  context_.diagnostics.latency("frame").add_ms(total_us / 1e3);
  ++frame_index_;
  give_up_where_lost(frame, result);
}

/// A map is given up that is too young to be missed, or that an earlier process has left and that is not of
/// this place.
void TrackerService::give_up_where_lost(const image::RgbdFrame& frame, const FrameResult& result) {
  const auto enough = static_cast<unsigned>(config_.tracker.quality.min_features_to_start);
  const bool is_usable = result.features >= enough + result.dynamic_features;
  if (resume_.take(frame.stamp_ns, has_pose(result.state), is_usable)) {
    spdlog::warn("not found in the map of the checkpoint within {} s of usable pictures", config_.resume_s);
    reset();
  } else if (tracker_.has_lost_young_map(frame.stamp_ns)) {
    reset();
  }
}

void TrackerService::sort_in_arrivals() {
  while (auto boxes = boxes_inbox_.try_pop()) {
    const auto stamp = static_cast<std::uint64_t>(messages::to_nanoseconds((*boxes)->header().stamp()));
    if (!boxes_.arrive(stamp, std::move(*boxes)))
      context_.diagnostics.reject("rds/boxes", service::Rejection::kUnexpected,
                                  "their keyframe waits for none");
  }
  while (auto poses = poses_inbox_.try_pop()) {
    const std::uint64_t answered = (*poses)->answered_keyframe_id();
    if ((*poses)->map_epoch() != map_epoch_)
      context_.diagnostics.reject("rds/keyframe/poses", service::Rejection::kOutdated, "another map epoch");
    else if (!loop_closer_.accept((*poses)->instance(), false))
      context_.diagnostics.reject("rds/keyframe/poses", service::Rejection::kForeign, "another loop closer");
    else
      loop_answers_.arrive_through(answered, *poses);
  }
  while (auto result = mapping_inbox_.try_pop()) {
    const std::uint64_t keyframe = result->keyframe;
    mappings_.arrive(keyframe, std::move(*result));
  }
}

/// In lockstep, and only here, a frame waits: for what is agreed to take effect at it.
void TrackerService::await_answers() {
  const auto deadline = Clock::now() + std::chrono::duration<double>(config_.lockstep.timeout_s);
  while (!stop_.stop_requested()) {
    beat();
    sort_in_arrivals();
    if (boxes_.complete(frame_index_) && loop_answers_.complete(frame_index_) &&
        mappings_.complete(frame_index_))
      return;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) break;
    mailbox_.wait_for(stop_, left, [this] {
      return !boxes_inbox_.locked_empty() || !poses_inbox_.locked_empty() || !mapping_inbox_.locked_empty();
    });
  }
  ++context_.diagnostics.counter("lockstep timeouts");
  spdlog::warn("frame {} goes on without an answer it waited {} s for", frame_index_,
               config_.lockstep.timeout_s);
}

void TrackerService::apply_answers() {
  const auto take = [this](auto& values) {
    return config_.lockstep.enabled ? values.take_due(frame_index_) : values.take_arrived();
  };
  for (const LocalMappingResult& result : take(mappings_)) guarded("local mapping", [&] { apply(result); });
  for (const PosesMessage& poses : take(loop_answers_)) guarded("rds/keyframe/poses", [&] { apply(poses); });
  for (const BoxesMessage& boxes : take(boxes_)) guarded("rds/boxes", [&] { apply(boxes); });
}

void TrackerService::apply(const LocalMappingResult& result) {
  tracker_.apply(result);
  const SelfCalibration& camera = tracker_.calibration();
  context_.diagnostics.counter("readout us") =
      static_cast<std::uint64_t>(std::max(0.0, camera.readout_s()) * 1e6);
  context_.diagnostics.counter("focal length permille") =
      static_cast<std::uint64_t>(std::lround(camera.focal_scale() * 1e3));
  publish_poses();
}

void TrackerService::apply(const PosesMessage& poses) {
  const bool same_closer = poses->instance() == loops_.instance;
  if (poses->revision() <= (same_closer ? loops_.revision : 0)) return;  // nothing new was closed
  const auto correction = messages::to_keyframe_poses(*poses);
  if (correction && correction->empty()) return;  // its poses came before
  if (!correction)
    return context_.diagnostics.reject("rds/keyframe/poses", service::Rejection::kInvalid,
                                       correction.error());
  const geometry::Pose before = tracker_.last_map_from_camera();
  tracker_.apply(PoseGraphCorrection{*correction});
  const geometry::Pose corrected_from_map = tracker_.last_map_from_camera() * before.inverse();
  outputs_.move_map(corrected_from_map);
  objects_.move_map(corrected_from_map);
  loops_ = {poses->instance(), poses->revision(), poses->loops_closed()};
  spdlog::info("loop {} closed, keyframe poses corrected", loops_.loops_closed);
  publish_poses();
  lasting_.schedule().hurry();  // a map that does not know this loop would not fit the mapper's
}

void TrackerService::apply(const BoxesMessage& boxes) {
  const std::int64_t stamp = messages::to_nanoseconds(boxes->header().stamp());
  const auto detections = messages::to_detections(*boxes);
  if (!detections)
    return context_.diagnostics.reject("rds/boxes", service::Rejection::kInvalid, detections.error());
  std::vector<prediction::ObjectObservation> observations;
  for (const auto& [label, score, box, id] : *detections) observations.push_back({box, label, score});
  ++box_sets_used_;
  const auto keyframe = keyframes_with_boxes_due_.extract(stamp);
  if (!keyframe) return objects_.observe(stamp, observations, std::nullopt);
  const auto& [id, camera_from_map, camera] = keyframe.mapped();
  objects_.observe(stamp, observations, prediction::KeyframeView{camera_from_map.inverse(), camera});
  tracker_.retract_movable(id, objects_.regions_of(observations, camera_from_map, camera));
}

void TrackerService::ask_for_answers(const KeyframeData& keyframe, const geometry::CameraModel& camera) {
  const LockstepConfig& lockstep = config_.lockstep;
  if (config_.dynamics) {
    boxes_.ask(static_cast<std::uint64_t>(keyframe.stamp_ns),
               frame_index_ + lockstep.detection_latency_frames);
    keyframes_with_boxes_due_.insert_or_assign(
        keyframe.stamp_ns, KeyframeAwaitingBoxes{keyframe.id, keyframe.map_from_camera.inverse(), camera});
    while (keyframes_with_boxes_due_.size() > kMaxAnswers)
      keyframes_with_boxes_due_.erase(keyframes_with_boxes_due_.begin());
  }
  const bool corrections_wanted =
      keyframe.in_map && config_.poses_file.empty() && (config_.loop_closer || !lockstep.enabled);
  if (corrections_wanted) loop_answers_.ask(keyframe.id, frame_index_ + lockstep.loop_latency_frames);
}

void TrackerService::start_mapping() {
  if (!mappings_.empty()) return;
  auto job = tracker_.take_mapping_job();
  if (!job) return;
  mappings_.ask(job->keyframe, frame_index_ + config_.lockstep.mapping_latency_frames);
  mapping_worker_.start(std::move(*job));
}

void TrackerService::publish_poses() {
  outputs_.publish_poses(tracker_.keyframe_poses(), loops_);
}

service::CommandOutcome TrackerService::execute(const std::string& verb, const std::string& /*argument*/) {
  if (verb == "finish") return finish();
  if (verb == "reset") {
    reset();
    return {true, fmt::format("map of {} keyframes, epoch {:016x}", tracker_.map().keyframes(), map_epoch_)};
  }
  if (verb == "pause" || verb == "resume") {
    paused_ = verb == "pause";
    return {true, paused_ ? "paused" : "resumed"};
  }
  return unknown_command(verb);
}

/// Nothing more comes: takes every answer that is still on its way and publishes the final poses.
service::CommandOutcome TrackerService::finish() {
  while (const auto frame = input_.frames().try_pop()) {
    beat();
    take(*frame);
  }
  const std::uint64_t last_frame = frame_index_;
  if (config_.lockstep.enabled) {
    for (; !(boxes_.empty() && loop_answers_.empty() && mappings_.empty()) && !stop_.stop_requested();
         ++frame_index_) {
      await_answers();
      apply_answers();
      start_mapping();
    }
  } else {
    apply_answers();
  }
  frame_index_ = last_frame;
  const auto poses = tracker_.keyframe_poses();
  const std::uint64_t revision = outputs_.publish_poses(poses, loops_, true);
  const std::size_t in_map = config_.tracker.localize_only ? 0 : poses.size();
  return {true, nlohmann::json{{"poses_revision", revision},
                               {"keyframes", in_map},
                               {"keyframes_in_map", tracker_.map().keyframes()}}
                    .dump()};
}

void TrackerService::reset() {
  map_epoch_ = service::random_id();
  lasting_.clear();
  resume_.end();
  tracker_.reset();
  start_map();
  objects_.reset();
  outputs_.set_epoch(map_epoch_);
  boxes_.clear();
  keyframes_with_boxes_due_.clear();
  loop_answers_.clear();
  mappings_.clear();
  loops_ = {};
  spdlog::info("begins again, map epoch {:016x}", map_epoch_);
}

}  // namespace rds::tracker
