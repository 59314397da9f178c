// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/mapper_service.hpp"

#include <limits>

#include <spdlog/spdlog.h>

#include "common/messages/conversions.hpp"
#include "common/service/checkpoints.hpp"
#include "common/service/possible_poses.hpp"
#include "common/topics/endpoints.hpp"
#include "services/mapper/input/keyframe_input.hpp"
#include "services/mapper/spill_file.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kMaxWaiting = 20;
constexpr std::size_t kMaxMessages = 1000;
constexpr std::size_t kMaxBoxes = 100;  // messages whose keyframe has not come

/// Keyframes, both before and after the worker has looked at them.
std::size_t max_waiting(const MapperServiceConfig& config) {
  return config.lockstep ? std::numeric_limits<std::size_t>::max() : kMaxWaiting;
}

/// Of keyframe records: in the checkpoint, else in a file that goes with the process.
std::unique_ptr<SpillStorage> storage_of(MapperCheckpoints& checkpoints, const MapperServiceConfig& config) {
  if (auto storage = checkpoints.storage()) return storage;
  return std::make_unique<SpillFile>(config.mapper.correction.spill_folder);
}

}  // namespace

MapperService::MapperService(service::ServiceContext& context, const MapperServiceConfig& config)
    : Service(context),
      config_(config),
      tracker_(context.bus),
      loop_closer_(context.bus),
      checkpoints_(config.localize_only ? nullptr : service::open_checkpoints(context, config.maps, "mapper"),
               config.maps.checkpoint_s),
      mapper_(config.mapper, 0, storage_of(checkpoints_, config)),
      outputs_(context, config.mapper.grid),
      waiting_(max_waiting(config)),
      waiting_boxes_(kMaxBoxes),
      map_commands_(mailbox_, config.maps, map_file::kMapper),
      images_inbox_(mailbox_, max_waiting(config)),
      boxes_inbox_(mailbox_, kMaxMessages),
      poses_inbox_(mailbox_, kMaxMessages) {
  mapper_.report_progress_to([this] { beat(); });
  if (!config.map_file.empty()) {
    read_start();
    publish_all();
  }
  go_on_from_checkpoint();
  if (!config.localize_only) subscribe_to_keyframes();
  subscriptions_.push_back(subscribe_to_instances(topics::kKeyframePoses, topics::kMapper, [this](Poses m) {
    if (service::is_possible(*m, context_.diagnostics)) poses_inbox_.push(std::move(m));
  }));
  context.diagnostics.gauge("keyframes waiting", [this] { return images_inbox_.size() + waiting_.size(); });
  context.diagnostics.gauge("corrections lost", [this] { return corrections_lost_.load(); });
  context.diagnostics.gauge("keyframes dropped",
                            [this] { return images_inbox_.dropped() + waiting_.dropped(); });
}

/// The map as the process before this one had it, if it has left one.
void MapperService::go_on_from_checkpoint() {
  const auto keyframes = checkpoints_.restore(mapper_);
  if (!keyframes) {
    spdlog::warn("the map of the checkpoint is not used: {}", keyframes.error());
    return mapper_.reset(mapper_.map_epoch());
  }
  for (const Integrated& keyframe : *keyframes) {
    integrated_by_stamp_[keyframe.stamp_ns] = keyframe;
    last_keyframe_id_ = keyframe.id;
    last_stamp_ns_ = keyframe.stamp_ns;
  }
  if (keyframes->empty()) return;
  spdlog::info("goes on in a map of {} keyframes, epoch {:016x}", mapper_.archive().size(), mapper_.map_epoch());
  publish_all();
}

void MapperService::subscribe_to_keyframes() {
  keyframes_.emplace(
      context_, topics::kMapper,
      [this](auto receiver) {
        return subscribe_to_instances(topics::kKeyframeImages, topics::kMapper, std::move(receiver));
      },
      [this](Images m) { images_inbox_.push(std::move(m)); });
  subscriptions_.push_back(topics::subscribe(context_.bus, topics::kBoxes, topics::kMapper,
                                             [this](Boxes m) { boxes_inbox_.push(std::move(m)); }));
}

void MapperService::run(const std::stop_token& stop) {
  stop_ = stop;
  while (wait(stop, [this] {
    return has_messages() || !commands_.locked_empty() || map_commands_.locked_ready();
  })) {
    handle_commands();
    map_commands_.settle();
    take_messages();
    idle();
  }
}

/// What may be due whether something has arrived or not.
void MapperService::idle() {
  if (mapper_.revision() > 0 && !outputs_.is_busy() && outputs_.has_new_reader()) publish_all();
  if (paused_) return;
  guarded(topics::kKeyframePoses.name, [this] { correct(); });
  integrate_ready();
  checkpoints_.save(mapper_);
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
  const std::size_t lost = mapper_.archive().lost();
  if (lost > corrections_lost_)
    spdlog::warn("{} keyframes cannot be kept for pose corrections: {} has no room, or lost what was written",
                 lost,
                 config_.mapper.correction.spill_folder.empty() ? "the folder for temporary files"
                                                                : config_.mapper.correction.spill_folder);
  corrections_lost_ = lost;
}

void MapperService::integrate_ready() {
  while (!waiting_.empty() && is_ready(waiting_.oldest()))
    guarded(topics::kKeyframeImages.name, [this] {
      beat();
      integrate(waiting_.take_oldest());
    });
}

bool MapperService::is_ready(const Images& images) const {
  const std::int64_t stamp = messages::to_nanoseconds(images->header().stamp());
  if (!config_.expect_boxes || waiting_boxes_.contains(stamp)) return true;
  if (config_.lockstep)  // boxes come in the order of the keyframes: these were lost when a mapper was killed
    return waiting_boxes_.has_later_than(stamp);
  return static_cast<double>(waiting_.span_ns()) * 1e-9 > config_.boxes_timeout_s;
}

void MapperService::integrate(const Images& images) {
  const auto started = std::chrono::steady_clock::now();
  auto input = to_keyframe_input(images);
  if (!input)
    return context_.diagnostics.reject(topics::kKeyframeImages.name, service::Rejection::kInvalid,
                                       input.error());
  const geometry::Pose camera_from_map = input->map_from_camera.inverse();
  if (const Boxes boxes = waiting_boxes_.take(input->stamp_ns))
    input->boxes = labelled_boxes(boxes, camera_from_map, input->camera);
  const auto known = std::ranges::find(poses_, input->id, &KeyframePose::id);
  if (known != poses_.end()) input->map_from_camera = known->map_from_camera;
  MapDelta delta;
  try {
    delta = mapper_.integrate(*input);
  } catch (const std::invalid_argument& e) {
    return context_.diagnostics.reject(topics::kKeyframeImages.name, service::Rejection::kInvalid, e.what());
  }
  const Integrated integrated{input->id, input->stamp_ns, camera_from_map, input->camera};
  integrated_by_stamp_.insert_or_assign(input->stamp_ns, integrated);
  checkpoints_.add(integrated);
  report_losses();
  last_keyframe_id_ = input->id;
  last_stamp_ns_ = input->stamp_ns;
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
