// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/mapper_service.hpp"

#include <limits>

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "services/mapper/labelled_boxes.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kMaxWaiting = 20;
constexpr std::size_t kMaxMessages = 100;
constexpr std::uint8_t kLocal = 0;
constexpr std::chrono::seconds kRestLimit{30};          // lockstep: everything that was sent must come
constexpr std::chrono::milliseconds kQuietLimit{1500};  // real time: what has not come by then was dropped

}  // namespace

MapperService::MapperService(service::ServiceContext& context, const MapperServiceConfig& config)
    : Service(context),
      config_(config),
      mapper_(config.mapper),
      outputs_(context),
      images_inbox_(mailbox_, config.lockstep ? std::numeric_limits<std::size_t>::max() : kMaxWaiting),
      boxes_inbox_(mailbox_, kMaxMessages),
      poses_inbox_(mailbox_, kMaxMessages) {
  if (!config.map_file.empty()) {
    if (const auto started = start_from(config.map_file); !started) throw std::runtime_error(started.error());
    outputs_.publish_all(mapper_, progress(), last_stamp_ns_);
  }
  if (!config.localize_only) subscribe_to_keyframes();
  subscriptions_.push_back(context.bus.subscribe<rds_msgs::msg::KeyFramePoses>(
      "rds/keyframe/poses", bus::kLatchedEvery, [this](Poses m) { poses_inbox_.push(std::move(m)); }));
  context.diagnostics.gauge("keyframes waiting", [this] { return images_inbox_.size(); });
  context.diagnostics.gauge("keyframes dropped", [this] { return images_inbox_.dropped(); });
}

void MapperService::subscribe_to_keyframes() {
  subscriptions_.push_back(context_.bus.subscribe<rds_msgs::msg::KeyFrameImages>(
      "rds/keyframe/images", bus::kKeyframeImages, [this](Images m) { images_inbox_.push(std::move(m)); }));
  subscriptions_.push_back(context_.bus.subscribe<vision_msgs::msg::Detection3DArray>(
      "rds/boxes", bus::kStream, [this](Boxes m) { boxes_inbox_.push(std::move(m)); }));
}

bool MapperService::something_arrived() const {
  return !images_inbox_.locked_empty() || !boxes_inbox_.locked_empty() || !poses_inbox_.locked_empty();
}

void MapperService::run(const std::stop_token& stop) {
  stop_ = stop;
  while (mailbox_.wait(stop, [this] { return something_arrived() || !commands_.locked_empty(); })) {
    handle_commands();
    take_arrivals();
    if (paused_) continue;
    correct();
    integrate_ready();
  }
}

void MapperService::take_arrivals() {
  while (const auto poses = poses_inbox_.try_pop()) take(*poses);
  while (const auto boxes = boxes_inbox_.try_pop()) take(*boxes);
  while (const auto images = images_inbox_.try_pop()) take(*images);
}

/// A new epoch is a new tracker, with the saved map or an empty one. Messages of an epoch that is over are
/// dropped.
bool MapperService::follow_epoch(std::uint64_t map_epoch, const std::string& topic) {
  if (map_epoch == mapper_.map_epoch()) return true;
  if (earlier_epochs_.contains(map_epoch)) {
    context_.diagnostics.reject(topic, "of an earlier map epoch");
    return false;
  }
  earlier_epochs_.insert(mapper_.map_epoch());
  spdlog::info("map epoch {:016x}", map_epoch);
  mapper_.reset(map_epoch);
  waiting_.clear();
  boxes_by_stamp_.clear();
  integrated_by_stamp_.clear();
  poses_.clear();
  poses_revision_ = loop_revision_ = last_keyframe_id_ = 0;
  if (mapper_.revision() > 0) outputs_.publish_all(mapper_, progress(), last_stamp_ns_);
  return true;
}

void MapperService::take(const Images& images) {
  if (!follow_epoch(images->map_epoch(), "rds/keyframe/images")) return;
  const std::int64_t stamp = messages::to_nanoseconds(images->header().stamp());
  if (integrated_by_stamp_.contains(stamp)) return;
  waiting_.emplace(images->keyframe_id(), images);
}

void MapperService::take(const Boxes& boxes) {
  const std::int64_t stamp = messages::to_nanoseconds(boxes->header().stamp());
  const auto integrated = integrated_by_stamp_.find(stamp);
  if (integrated == integrated_by_stamp_.end()) {
    boxes_by_stamp_[stamp] = boxes;
  } else {
    const auto& [id, camera_from_map, camera] = integrated->second;
    const auto labelled = to_labelled_boxes(*boxes, camera_from_map, camera, config_.mapper);
    if (!labelled) return context_.diagnostics.reject("rds/boxes", labelled.error());
    mapper_.set_boxes(id, *labelled);
  }
  while (boxes_by_stamp_.size() > kMaxMessages) boxes_by_stamp_.erase(boxes_by_stamp_.begin());
}

void MapperService::take(const Poses& message) {
  if (!follow_epoch(message->map_epoch(), "rds/keyframe/poses")) return;
  auto poses = messages::to_keyframe_poses(*message);
  if (!poses) return context_.diagnostics.reject("rds/keyframe/poses", poses.error());
  if (message->loop_revision() < loop_revision_) return;  // does not know the loop yet that we have applied
  if (poses->empty()) return;
  poses_changed_by_loop_ |= message->loop_revision() > loop_revision_;
  loop_revision_ = message->loop_revision();
  poses_ = std::move(*poses);
  if (message->source() == kLocal) poses_revision_ = message->revision();
}

/// Moves the map after a loop, and now and then after what local bundle adjustment has moved.
void MapperService::correct() {
  if (poses_.empty() || (!poses_changed_by_loop_ && since_correction_ < config_.local_correction_every))
    return;
  const auto started = std::chrono::steady_clock::now();
  const MapDelta delta = mapper_.apply_poses(poses_);
  poses_changed_by_loop_ = false;
  since_correction_ = 0;
  if (delta.is_noop()) return;
  publish(delta);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
  context_.diagnostics.latency("correction").add_ms(took.count());
}

void MapperService::integrate_ready() {
  while (!waiting_.empty() && is_ready(waiting_.begin()->second)) {
    const Images images = waiting_.begin()->second;
    waiting_.erase(waiting_.begin());
    integrate(images);
  }
}

bool MapperService::is_ready(const Images& images) const {
  const std::int64_t stamp = messages::to_nanoseconds(images->header().stamp());
  if (!config_.expect_boxes || boxes_by_stamp_.contains(stamp)) return true;
  if (config_.lockstep) return false;
  const std::int64_t newest = messages::to_nanoseconds(waiting_.rbegin()->second->header().stamp());
  return static_cast<double>(newest - stamp) * 1e-9 > config_.boxes_timeout_s;
}

void MapperService::integrate(const Images& images) {
  const auto started = std::chrono::steady_clock::now();
  auto frame = messages::to_rgbd_frame(images);
  if (!frame) return context_.diagnostics.reject("rds/keyframe/images", frame.error());
  const auto map_from_camera = messages::to_pose(images->map_from_camera());
  if (!map_from_camera) return context_.diagnostics.reject("rds/keyframe/images", map_from_camera.error());
  auto movable = messages::to_cell_mask(images->movable(), frame->color.pixels.size());
  if (!movable) return context_.diagnostics.reject("rds/keyframe/images", movable.error());
  KeyframeInput input{images->keyframe_id(), frame->stamp_ns, *map_from_camera, frame->color,
                      frame->depth,          frame->camera,   std::nullopt,     std::move(*movable)};
  const auto known = std::ranges::find(poses_, input.id, &KeyframePose::id);
  if (known != poses_.end()) input.map_from_camera = known->map_from_camera;
  const geometry::Pose camera_from_map = map_from_camera->inverse();
  if (const auto boxes = boxes_by_stamp_.extract(frame->stamp_ns)) {
    if (auto labelled = to_labelled_boxes(*boxes.mapped(), camera_from_map, frame->camera, config_.mapper))
      input.boxes = std::move(*labelled);
    else
      context_.diagnostics.reject("rds/boxes", labelled.error());
  }
  MapDelta delta;
  try {
    delta = mapper_.integrate(input);
  } catch (const std::invalid_argument& e) {
    return context_.diagnostics.reject("rds/keyframe/images", e.what());
  }
  integrated_by_stamp_.insert_or_assign(frame->stamp_ns,
                                        Integrated{input.id, camera_from_map, frame->camera});
  last_keyframe_id_ = input.id;
  last_stamp_ns_ = frame->stamp_ns;
  ++since_full_;
  ++since_correction_;
  publish(delta);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
  context_.diagnostics.latency("keyframe").add_ms(took.count());
}

void MapperService::publish(const MapDelta& delta) {
  outputs_.publish_delta(delta);
  if (outputs_.has_new_reader() || since_full_ >= config_.full_map_every) {
    since_full_ = 0;
    outputs_.publish_all(mapper_, progress(), last_stamp_ns_);
  } else {
    outputs_.publish_info(mapper_, progress(), last_stamp_ns_);
  }
}

MapProgress MapperService::progress() const {
  return {last_keyframe_id_, waiting_.size()};
}

service::CommandOutcome MapperService::execute(const std::string& verb, const std::string& argument) {
  if (verb == "finish") return finish(argument);
  if (verb == "save") return save(argument);
  if (verb == "load") return load(argument);
  if (verb == "reset") {
    const std::uint64_t epoch = mapper_.map_epoch();
    mapper_.reset(epoch);
    waiting_.clear();
    integrated_by_stamp_.clear();
    return {true, fmt::format("map of {} nodes", mapper_.tree().size())};
  }
  if (verb == "pause" || verb == "resume") {
    paused_ = verb == "pause";
    return {true, paused_ ? "paused" : "resumed"};
  }
  return unknown_command(verb);
}

/// Nothing more comes: integrates the rest, then makes the map again from scratch with the final poses, so
/// that it depends on the data alone and not on when they arrived.
service::CommandOutcome MapperService::finish(const std::string& argument) {
  const auto json = nlohmann::json::parse(argument, nullptr, false);
  const std::uint64_t revision = json.is_object() ? json.value("poses_revision", std::uint64_t{0}) : 0;
  const std::uint64_t keyframes = json.is_object() ? json.value("keyframes", std::uint64_t{0}) : 0;
  wait_for_rest(revision, keyframes);
  while (!waiting_.empty()) {
    const Images images = waiting_.begin()->second;
    waiting_.erase(waiting_.begin());
    integrate(images);
  }
  outputs_.publish_delta(mapper_.settle(poses_));
  outputs_.publish_all(mapper_, progress(), last_stamp_ns_);
  const bool complete =
      poses_revision_ >= revision && (!config_.lockstep || mapper_.keyframes() >= keyframes);
  const Eigen::Vector3d up = mapper_.up_in_map();
  return {complete, nlohmann::json{{"keyframes", mapper_.keyframes()},
                                   {"poses_revision", poses_revision_},
                                   {"revision", mapper_.revision()},
                                   {"up", {up.x(), up.y(), up.z()}},
                                   {"labels", mapper_.labels().names()}}
                        .dump()};
}

void MapperService::wait_for_rest(std::uint64_t poses_revision, std::uint64_t keyframes) {
  using Clock = std::chrono::steady_clock;
  auto deadline = Clock::now() + (config_.lockstep ? std::chrono::milliseconds(kRestLimit) : kQuietLimit);
  while (!stop_.stop_requested()) {
    take_arrivals();
    integrate_ready();
    if (poses_revision_ >= poses_revision && mapper_.keyframes() >= keyframes) return;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return;
    mailbox_.wait_for(stop_, left, [this] { return something_arrived(); });
  }
}

}  // namespace rds::mapper
