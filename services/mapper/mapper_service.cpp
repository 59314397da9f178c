// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/mapper_service.hpp"

#include <limits>

#include <spdlog/spdlog.h>

#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "common/messages/keyframe_conversions.hpp"
#include "services/mapper/labelled_boxes.hpp"
#include "services/mapper/spill_file.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kMaxWaiting = 20;
constexpr std::size_t kMaxMessages = 100;
constexpr std::uint8_t kLocal = 0;
constexpr std::chrono::milliseconds kReaderLook{500};  // between looks for somebody new while nothing arrives

}  // namespace

MapperService::MapperService(service::ServiceContext& context, const MapperServiceConfig& config)
    : Service(context),
      config_(config),
      mapper_(config.mapper, 0, std::make_unique<SpillFile>(config.mapper.correction.spill_folder)),
      outputs_(context, config.mapper.grid),
      images_inbox_(mailbox_, config.lockstep ? std::numeric_limits<std::size_t>::max() : kMaxWaiting),
      boxes_inbox_(mailbox_, kMaxMessages),
      poses_inbox_(mailbox_, kMaxMessages) {
  if (!config.map_file.empty()) {
    if (const auto started = start_from(config.map_file); !started) throw std::runtime_error(started.error());
    publish_all();
  }
  if (!config.localize_only) subscribe_to_keyframes();
  subscriptions_.push_back(context.bus.subscribe<rds_msgs::msg::KeyFramePoses>(
      "rds/keyframe/poses", bus::kLatchedEvery, [this](Poses m) { poses_inbox_.push(std::move(m)); }));
  context.diagnostics.gauge("keyframes waiting", [this] { return images_inbox_.size(); });
  context.diagnostics.gauge("corrections lost", [this] { return corrections_lost_.load(); });
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
  while (!stop.stop_requested()) {
    mailbox_.wait_for(stop, kReaderLook, [this] { return something_arrived() || !commands_.locked_empty(); });
    handle_commands();
    take_arrivals();
    if (mapper_.revision() > 0 && !outputs_.is_busy() && outputs_.has_new_reader()) publish_all();
    if (paused_) continue;
    correct();
    integrate_ready();
  }
}

void MapperService::take_arrivals() {
  while (const auto images = images_inbox_.try_pop()) take(*images);  // first: they begin an epoch
  while (const auto boxes = boxes_inbox_.try_pop()) take(*boxes);
  while (const auto poses = poses_inbox_.try_pop()) take(*poses);
}

/// Messages of an epoch that is over are dropped.
bool MapperService::is_over(std::uint64_t map_epoch, const std::string& topic) {
  if (!earlier_epochs_.contains(map_epoch)) return false;
  context_.diagnostics.reject(topic, "of an earlier map epoch");
  return true;
}

/// A new epoch is a new tracker, with the saved map or an empty one.
/// @param stamp_ns  of what it begins with: earlier boxes are of an epoch that is over.
void MapperService::begin_epoch(std::uint64_t map_epoch, std::int64_t stamp_ns) {
  earlier_epochs_.insert(mapper_.map_epoch());
  spdlog::info("map epoch {:016x}", map_epoch);
  mapper_.reset(map_epoch);
  outputs_.begin_map();
  forget_keyframes();
  boxes_by_stamp_.erase(boxes_by_stamp_.begin(), boxes_by_stamp_.lower_bound(stamp_ns));
  if (mapper_.revision() > 0) publish_all();
  if (const Poses early = std::exchange(early_poses_, nullptr)) take(early);
}

void MapperService::forget_keyframes() {
  waiting_.clear();
  integrated_by_stamp_.clear();
  poses_.clear();
  poses_changed_by_loop_ = false;
  poses_revision_ = loop_revision_ = last_keyframe_id_ = 0;
}

void MapperService::take(const Images& images) {
  if (is_over(images->map_epoch(), "rds/keyframe/images")) return;
  const std::int64_t stamp = messages::to_nanoseconds(images->header().stamp());
  if (images->map_epoch() != mapper_.map_epoch()) begin_epoch(images->map_epoch(), stamp);
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
    if (const auto labelled = labelled_boxes(boxes, camera_from_map, camera))
      mapper_.set_boxes(id, *labelled);
  }
  while (boxes_by_stamp_.size() > kMaxMessages) boxes_by_stamp_.erase(boxes_by_stamp_.begin());
}

/// @return nullopt, counted, for a message that cannot be used; boxes that cannot be are counted and left
/// out.
std::optional<std::vector<LabelledBox>> MapperService::labelled_boxes(const Boxes& boxes,
                                                                      const geometry::Pose& camera_from_map,
                                                                      const geometry::CameraModel& camera) {
  auto labelled = to_labelled_boxes(*boxes, camera_from_map, camera, config_.mapper);
  if (!labelled) {
    context_.diagnostics.reject("rds/boxes", labelled.error());
    return std::nullopt;
  }
  context_.diagnostics.counter("impossible boxes") += labelled->impossible;
  return std::move(labelled->boxes);
}

/// Only keyframes begin an epoch: a loop closer that still speaks of an earlier one must not. Without them
/// (localize_only) poses do.
void MapperService::take(const Poses& message) {
  if (is_over(message->map_epoch(), "rds/keyframe/poses")) return;
  if (message->map_epoch() != mapper_.map_epoch()) {
    if (!config_.localize_only) {
      if (early_poses_ && early_poses_->map_epoch() != message->map_epoch())
        context_.diagnostics.reject("rds/keyframe/poses", "of an unknown map epoch");
      early_poses_ = message;
      return;
    }
    begin_epoch(message->map_epoch(), messages::to_nanoseconds(message->header().stamp()));
  }
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
  MapDelta delta = mapper_.apply_poses(poses_);
  poses_changed_by_loop_ = false;
  since_correction_ = 0;
  report_losses();
  if (delta.is_noop()) return;
  publish(std::move(delta));
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
  context_.diagnostics.latency("correction").add_ms(took.count());
}

/// Disk full, or a file that gave back other bytes: the map goes on, some keyframes follow corrections no
/// more.
void MapperService::report_losses() {
  const std::size_t lost = mapper_.corrections_lost();
  if (lost > corrections_lost_)
    spdlog::warn("{} keyframes cannot be kept for pose corrections: {} has no room, or lost what was written",
                 lost,
                 config_.mapper.correction.spill_folder.empty() ? "the folder for temporary files"
                                                                : config_.mapper.correction.spill_folder);
  corrections_lost_ = lost;
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
    input.boxes = labelled_boxes(boxes.mapped(), camera_from_map, frame->camera);
  }
  MapDelta delta;
  try {
    delta = mapper_.integrate(input);
  } catch (const std::invalid_argument& e) {
    return context_.diagnostics.reject("rds/keyframe/images", e.what());
  }
  integrated_by_stamp_.insert_or_assign(frame->stamp_ns,
                                        Integrated{input.id, camera_from_map, frame->camera});
  report_losses();
  last_keyframe_id_ = input.id;
  last_stamp_ns_ = frame->stamp_ns;
  ++since_full_;
  ++since_correction_;
  publish(std::move(delta));
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
  context_.diagnostics.latency("keyframe").add_ms(took.count());
}

void MapperService::publish(MapDelta delta) {
  outputs_.publish_delta(std::move(delta));
  if (since_full_ >= config_.full_map_every && !outputs_.is_busy())
    publish_all();
  else
    outputs_.publish_info(mapper_, progress(), last_stamp_ns_);
}

void MapperService::publish_all() {
  since_full_ = 0;
  outputs_.publish_all(mapper_, progress(), last_stamp_ns_);
}

MapProgress MapperService::progress() const {
  return {last_keyframe_id_, waiting_.size()};
}

}  // namespace rds::mapper
