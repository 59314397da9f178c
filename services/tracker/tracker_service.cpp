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
#include "common/topics/endpoints.hpp"
#include "services/tracker/input/pose_file.hpp"
#include "services/tracker/saved_start.hpp"

namespace rds::tracker {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kLiveFrames =
    5;  // waiting while one is processed (as the topic keeps); older ones are dropped
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
      tracker_(
          config.tracker, read_given_poses(config.poses_file, config.poses_max_gap_s),
          [this](std::size_t count, const auto& part) { parallel_for_.run(count, part); }, now_us),
      checkpoints_(
          keeps_checkpoint(config) ? service::open_checkpoints(context, config.maps, "tracker") : nullptr,
          config.maps.checkpoint_s),
      resume_(config.resume_s),
      objects_(config.prediction),
      outputs_(context, map_epoch_),
      input_(context, mailbox_, config.camera,
             config.lockstep.enabled ? std::numeric_limits<std::size_t>::max() : kLiveFrames),
      stamps_(!config.lockstep.enabled),
      answers_(context, mailbox_, config.lockstep),
      map_commands_(mailbox_, config.maps, map_file::kTracker),
      mapping_worker_(config.tracker.local_mapping, config.mapping_nice, answers_.mapping_results()),
      boxes_subscription_(topics::subscribe(context.bus, topics::kBoxes, topics::kTracker,
                                            [this](BoxesMessage m) { answers_.push(std::move(m)); })),
      poses_subscription_(
          subscribe_to_instances(topics::kKeyframePoses, topics::kTracker, [this](PosesMessage m) {
            if (m->source() == kLoop && service::is_possible(*m, context_.diagnostics))
              answers_.push(std::move(m));
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
  const auto frames_wait = [this] { return paused_ && config_.lockstep.enabled; };  // else they are dropped
  while (wait(stop, [&] {
    return (!frames_wait() && !input_.frames().locked_empty()) || !commands_.locked_empty() ||
           answers_.locked_ready() || map_commands_.locked_ready();
  })) {
    handle_commands();
    map_commands_.settle();
    answers_.sort_in(map_epoch_);
    if (frames_wait()) continue;
    if (const auto frame = input_.frames().try_pop())
      if (!guarded("frame", [&] { take(*frame); })) guarded("frame", [&] { acknowledge(*frame); });
    if (checkpoints_.is_due()) save_checkpoint();
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
  answers_.forget_boxes();
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
  if (result.keyframe) checkpoints_.schedule().note_keyframe();
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

/// In lockstep, and only here, a frame waits: for what is agreed to take effect at it.
void TrackerService::await_answers() {
  const auto deadline = Clock::now() + std::chrono::duration<double>(config_.lockstep.timeout_s);
  while (!stop_.stop_requested()) {
    beat();
    answers_.sort_in(map_epoch_);
    if (answers_.complete(frame_index_)) return;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) break;
    mailbox_.wait_for(stop_, left, [this] { return answers_.locked_ready(); });
  }
  ++context_.diagnostics.counter("lockstep timeouts");
  spdlog::warn("frame {} goes on without an answer it waited {} s for", frame_index_,
               config_.lockstep.timeout_s);
}

void TrackerService::apply_answers() {
  for (const LocalMappingResult& result : answers_.take_mappings(frame_index_))
    guarded("local mapping", [&] { apply(result); });
  for (const PosesMessage& poses : answers_.take_poses(frame_index_))
    guarded(topics::kKeyframePoses.name, [&] { apply(poses); });
  for (const BoxesMessage& boxes : answers_.take_boxes(frame_index_))
    guarded(topics::kBoxes.name, [&] { apply(boxes); });
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
    return context_.diagnostics.reject(topics::kKeyframePoses.name, service::Rejection::kInvalid,
                                       correction.error());
  const geometry::Pose before = tracker_.last_map_from_camera();
  tracker_.apply(PoseGraphCorrection{*correction});
  const geometry::Pose corrected_from_map = tracker_.last_map_from_camera() * before.inverse();
  outputs_.move_map(corrected_from_map);
  objects_.move_map(corrected_from_map);
  loops_ = {poses->instance(), poses->revision(), poses->loops_closed()};
  spdlog::info("loop {} closed, keyframe poses corrected", loops_.loops_closed);
  publish_poses();
  checkpoints_.schedule().hurry();  // a map that does not know this loop would not fit the mapper's
}

void TrackerService::apply(const BoxesMessage& boxes) {
  const std::int64_t stamp = messages::to_nanoseconds(boxes->header().stamp());
  const auto detections = messages::to_detections(*boxes);
  if (!detections)
    return context_.diagnostics.reject(topics::kBoxes.name, service::Rejection::kInvalid, detections.error());
  std::vector<prediction::ObjectObservation> observations;
  for (const auto& [label, score, box, id] : *detections) observations.push_back({box, label, score});
  ++box_sets_used_;
  const auto keyframe = answers_.take_snapshot(stamp);
  if (!keyframe) return objects_.observe(stamp, observations, std::nullopt);
  const auto& [id, camera_from_map, camera] = *keyframe;
  objects_.observe(stamp, observations, prediction::KeyframeView{camera_from_map.inverse(), camera});
  tracker_.retract_movable(id, objects_.regions_of(observations, camera_from_map, camera));
}

void TrackerService::ask_for_answers(const KeyframeData& keyframe, const geometry::CameraModel& camera) {
  if (config_.dynamics)
    answers_.ask_for_boxes(keyframe.stamp_ns, {keyframe.id, keyframe.map_from_camera.inverse(), camera},
                           frame_index_);
  const bool corrections_wanted =
      keyframe.in_map && config_.poses_file.empty() && (config_.loop_closer || !config_.lockstep.enabled);
  if (corrections_wanted) answers_.ask_for_poses(keyframe.id, frame_index_);
}

void TrackerService::start_mapping() {
  if (answers_.is_mapping()) return;
  auto job = tracker_.take_mapping_job();
  if (!job) return;
  answers_.ask_for_mapping(job->keyframe, frame_index_);
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
    for (; !answers_.empty() && !stop_.stop_requested(); ++frame_index_) {
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
  checkpoints_.clear();
  resume_.end();
  tracker_.reset();
  start_map();
  objects_.reset();
  outputs_.set_epoch(map_epoch_);
  answers_.clear();
  loops_ = {};
  spdlog::info("begins again, map epoch {:016x}", map_epoch_);
}

}  // namespace rds::tracker
