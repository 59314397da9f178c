// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/tracker_service.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <spdlog/spdlog.h>

#include "common/concurrency/parallel_for.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/detection_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "common/messages/keyframe_pose_table.hpp"
#include "common/service/possible_poses.hpp"
#include "common/time/steady_time.hpp"
#include "common/topics/endpoints.hpp"
#include "services/tracker/input/pose_file.hpp"

namespace rds::tracker {
namespace {

/// On the calling thread, the worker, and on a helper of its own.
Executor executor_with_helper() {
  return [helper = std::make_shared<concurrency::ParallelFor>()](std::size_t count, const auto& part) {
    helper->run(count, part);
  };
}

/// Which way the map that begins calls up.
void tell(const UpDirection& up) {
  const double tilt_deg = std::acos(std::clamp(-up.up.y(), -1.0, 1.0)) * 180 / std::numbers::pi;
  if (up.is_seen)
    return spdlog::info(
        "the map is level: the camera is tilted by {:.1f} degrees, {:.0f} % of {} surfaces are level, {:.0f} "
        "% "
        "upright",
        tilt_deg, 100 * up.level, up.surfaces, 100 * up.upright);
  spdlog::warn(
      "the first picture does not show which way is up ({} plane surfaces), the map's z is a guess, {:.0f} "
      "degrees from the camera's: show it floor or walls, or set map_frame.up_in_camera",
      up.surfaces, tilt_deg);
}

}  // namespace

TrackerService::TrackerService(service::ServiceContext& context, const TrackerServiceConfig& config)
    : Service(context),
      config_(config),
      tracker_(config.tracker, ports()),
      epoch_(context, config, tracker_),
      objects_(config.prediction),
      outputs_(context, config.frames, epoch_.id()),
      input_(context, mailbox_, config.camera, config.lockstep.enabled, look_up()),
      robot_(context, mailbox_,
             {config.inputs, config.frames.base,
              config.lockstep.enabled ? std::optional(config.lockstep.timeout_s) : std::nullopt},
             look_up()),
      answers_(context, mailbox_, config.lockstep, config.mapping_nice),
      pictures_(config.mapping_nice),
      map_commands_(mailbox_, config.maps, map_file::kTracker),
      saved_map_services_(context) {
  subscriptions_.push_back(topics::subscribe(context.bus, topics::kBoxes, topics::kTracker,
                                             [this](BoxesMessage m) { answers_.push(std::move(m)); }));
  subscriptions_.push_back(
      subscribe_to_instances(topics::kKeyframePoses, topics::kTracker, [this](PosesMessage m) {
        if (m->source() == messages::kPosesOfLoopCloser && service::is_possible(*m, context_.diagnostics))
          answers_.push(std::move(m));
      }));
  if (epoch_.is_resuming()) publish_poses();
}

TrackerPorts TrackerService::ports() {
  TrackerPorts ports{.given_poses = read_given_poses(config_.poses_file, config_.poses_max_gap_s),
                     .executor = executor_with_helper(),
                     .now_us = time::now_us};
  if (config_.inputs.reads_odometry())
    ports.odometry = [this](std::int64_t stamp_ns) { return robot_.odometry_at(stamp_ns); };
  if (!config_.inputs.imu.empty())
    ports.gyroscope = [this](std::int64_t from_ns, std::int64_t to_ns) {
      return robot_.turn_of_camera(from_ns, to_ns);
    };
  return ports;
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
    answers_.sort_in(epoch_.id());
    if (frames_wait()) continue;
    if (const auto frame = input_.frames().try_pop())
      if (!guarded("frame", [&] { take(*frame); })) guarded("frame", [&] { acknowledge(*frame); });
    epoch_.save_if_due();
  }
}

/// A new subscriber gets all poses even while no frame comes.
void TrackerService::idle() {
  if (outputs_.has_new_reader()) publish_poses();
}

/// Time is what the stamps of the frames say: a frame of another time than those before is not tracked.
void TrackerService::take(const image::RgbdFrame& frame) {
  const time::StampVerdict verdict = input_.stamps().take(frame.stamp_ns);
  if (verdict == time::StampVerdict::kBreak) begin_after_break();
  if (verdict == time::StampVerdict::kGap) ++context_.diagnostics.counter("time gaps");
  if (paused_) {
    ++context_.diagnostics.counter("frames while paused");
    return;
  }
  if (verdict != time::StampVerdict::kDoubt && verdict != time::StampVerdict::kLate) return process(frame);
  ++context_.diagnostics.counter("frames out of time");
  acknowledge(frame);
}

/// Where stamps go back, boxes and predictions of before mean nothing: their stamps are of another time.
/// Where they go ahead, these are too old by themselves.
void TrackerService::begin_after_break() {
  ++context_.diagnostics.counter("time breaks");
  const std::int64_t break_ns = input_.stamps().break_ns();
  spdlog::warn(
      "the camera's stamps go on {:+.3f} s from the last ones: a clock that was set, a recording that "
      "begins again, or a long gap",
      static_cast<double>(break_ns) * 1e-9);
  if (break_ns > 0) return;
  objects_.reset();
  answers_.forget_boxes();
}

void TrackerService::process(const image::RgbdFrame& frame) {
  if (epoch_.is_of_another_camera(frame)) reset();
  answers_.await(frame_index_, epoch_.id(), stop_, [this] { beat(); });
  robot_.go_to(frame.stamp_ns, input_.camera_frame(), stop_, [this] { beat(); });
  seek();
  tracker_.set_up(robot_.up_in_camera(frame.stamp_ns));
  const std::int64_t started_us = time::now_us();
  apply_answers();
  const std::int64_t predict_started_us = time::now_us();
  const auto regions =
      objects_.regions(frame.stamp_ns, tracker_.expected_camera_from_map(frame.stamp_ns), frame.camera);
  std::uint32_t predict_us = time::microseconds_since(predict_started_us);
  const SubmapId submap_before = tracker_.submap();
  const FrameResult result = tracker_.track(frame, regions);
  if (tracker_.submap() != submap_before) change_submap(result);
  if (result.up && !result.begins_submap) tell(*result.up);
  const std::int64_t project_started_us = time::now_us();
  const auto objects = objects_.in_image(frame.stamp_ns, result.map_from_camera.inverse(), frame.camera);
  predict_us += time::microseconds_since(project_started_us);
  if (result.keyframe) ask_for_answers(*result.keyframe, frame.camera);
  const auto poses = result.keyframe ? tracker_.keyframe_poses() : std::vector<KeyframePose>{};
  const bool is_placed = result.submap == Submaps::kMap;
  if (result.keyframe && !is_placed) outputs_.publish_submap(tracker_.keyframe_poses(result.submap));
  const FrameReport report{
      frame,      result,           input_.camera_frame(), objects,        frame_index_, predict_us,
      started_us, input_.dropped(), objects_.observed(),   epoch_.loops(), poses};
  outputs_.publish(report);
  if (result.keyframe) {
    if (is_placed) outputs_.publish_poses(poses, epoch_.loops());
    epoch_.note_keyframe();
    join_submaps(report);
  }
  if (result.keyframe) move_pictures(result.keyframe->id);
  start_mapping();
  if (!config_.inputs.imu.empty()) {
    context_.diagnostics.counter("turns by the gyroscope") = tracker_.gyroscope().told();
    context_.diagnostics.counter("gyroscope windows refused") = tracker_.gyroscope().refused();
  }
  context_.diagnostics.latency("frame").add_ms(time::microseconds_since(started_us) / 1e3);
  ++frame_index_;
  if (epoch_.is_over(frame, result)) reset();
}

/// Where somebody says that the camera is, a lost one looks for itself.
void TrackerService::seek() {
  const auto place = robot_.take_sought_place();
  if (!place) return;
  const Eigen::Vector3d at = place->map_from_camera.translation();
  if (tracker_.seek(*place))
    spdlog::info("lost, looks for itself around ({:.2f}, {:.2f}), within {:.1f} m", at.x(), at.y(),
                 place->radius_m);
  else
    spdlog::info("an initial pose at ({:.2f}, {:.2f}) is not used: the camera is not lost", at.x(), at.y());
}

/// In another submap what moves stands elsewhere, and boxes on their way are in the frame of the one before.
void TrackerService::change_submap(const FrameResult& result) {
  if (result.begins_submap)
    spdlog::warn("lost for {} s: submap {} begins beside the map", config_.tracker.submap_after_s,
                 result.submap);
  ++place_;
  objects_.reset();
}

/// The older one of two submaps stays where it is; if it is the map, the younger one's keyframes are for all
/// from now on.
void TrackerService::join_submaps(const FrameReport& report) {
  const geometry::Pose before = tracker_.last_map_from_camera();
  const SubmapId submap_before = tracker_.submap();
  const auto joined = tracker_.join_submaps();
  if (!joined) return;
  move_map(before);
  if (tracker_.submap() != submap_before) ++place_;
  publish_poses();
  const auto poses = tracker_.keyframe_poses();
  FrameReport now = report;
  now.keyframe_poses = poses;
  for (const KeyframeId id : joined->placed) outputs_.publish_features_of(tracker_.keyframe_data(id), now);
  ++context_.diagnostics.counter("submaps joined");
  spdlog::info("submap {} is joined to an older one, {} of its keyframes have a place in the map",
               joined->submap, joined->placed.size());
}

/// A frame that is not tracked gets no pose.
void TrackerService::acknowledge(const image::RgbdFrame& frame) {
  FrameResult result;
  if (tracker_.map().keyframes().size() > 0) result.state = State::kLost;
  outputs_.publish({frame,
                    result,
                    input_.camera_frame(),
                    {},
                    frame_index_,
                    0,
                    time::now_us(),
                    input_.dropped(),
                    objects_.observed()});
  ++frame_index_;
}

void TrackerService::move_pictures(KeyframeId newest) {
  while (auto moved = pictures_.try_pop())
    tracker_.move_picture(moved->keyframe, moved->before, std::move(moved->now));
  const Keyframe* keyframe = tracker_.map().keyframe(newest);
  if (keyframe != nullptr && keyframe->images) pictures_.move(newest, keyframe->images);
}

RobotInputs::LookUp TrackerService::look_up() {
  return [this](const std::string& target, const std::string& source, std::int64_t stamp_ns) {
    return outputs_.odometry().look_up(target, source, stamp_ns);
  };
}

void TrackerService::publish_poses() {
  outputs_.publish_poses(tracker_.keyframe_poses(), epoch_.loops());
  if (const SubmapId submap = tracker_.submap(); submap != Submaps::kMap)
    outputs_.publish_submap(tracker_.keyframe_poses(submap));
}

}  // namespace rds::tracker
