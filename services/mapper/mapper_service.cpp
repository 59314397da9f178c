// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/mapper_service.hpp"

#include <limits>

#include <spdlog/spdlog.h>

#include "common/messages/keyframe_pose_table.hpp"
#include "common/service/checkpoints.hpp"
#include "common/service/peers/peers.hpp"
#include "common/service/possible_poses.hpp"
#include "common/topics/endpoints.hpp"
#include "services/mapper/input/conversions.hpp"
#include "services/mapper/saved_start.hpp"
#include "services/mapper/spill_file.hpp"

namespace rds::mapper {
namespace {

constexpr std::size_t kMaxWaiting = 20;
constexpr std::size_t kMaxMessages = 1000;
constexpr std::size_t kMaxUnplaced = 128;  // 1.5 MB each, minutes of a submap
constexpr std::size_t kRestEvery = 100;    // keyframes; evidence of other places is in RAM until then
constexpr std::size_t kPlacedAtOnce = 2;   // of those, between keyframes that come

using service::Rejection;

/// Keyframes, both before and after the worker has looked at them.
std::size_t max_waiting(const MapperServiceConfig& config) {
  return config.lockstep ? std::numeric_limits<std::size_t>::max() : kMaxWaiting;
}

/// Of keyframe records: in the checkpoint, else in a file that goes with the process.
std::unique_ptr<SpillStorage> storage_of(MapperCheckpoints& checkpoints, const MapperServiceConfig& config) {
  if (auto storage = checkpoints.storage()) return storage;
  return std::make_unique<SpillFile>(config.mapper.correction.spill_folder);
}

EpochFollower::Accepts accepts(bus::Participant& bus, std::string_view kind) {
  return [writer = std::make_shared<service::FollowedWriter>(bus, kind)](
             std::uint64_t instance, bool same_map) { return writer->accept(instance, same_map); };
}

/// Disk full, or a file that gave back other bytes: the map goes on, some keyframes follow corrections no
/// more.
void report_losses(std::size_t lost, const std::string& spill_folder, service::Diagnostics& diagnostics) {
  auto& reported = diagnostics.counter("corrections lost");
  if (lost > reported)
    spdlog::warn("{} keyframes cannot be kept for pose corrections: {} has no room, or lost what was written",
                 lost, spill_folder.empty() ? "the folder for temporary files" : spill_folder);
  reported = lost;
}

double ms_since(std::chrono::steady_clock::time_point started) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started).count();
}

}  // namespace

MapperService::MapperService(service::ServiceContext& context, const MapperServiceConfig& config)
    : Service(context),
      config_(config),
      epochs_(accepts(context.bus, service::kTracker)),
      checkpoints_(config.localize_only ? nullptr : service::open_checkpoints(context, config.maps, "mapper"),
                   config.maps.checkpoint_s),
      evidence_memory_(config.mapper.correction.spill_folder),
      mapper_(config.mapper, 0, storage_of(checkpoints_, config), &evidence_memory_),
      outputs_(context, config.mapper.grid, config.full_map_every),
      queue_(max_waiting(config), {config.expect_boxes, config.lockstep, config.boxes_timeout_s}),
      unplaced_(kMaxUnplaced),
      map_commands_(mailbox_, config.maps, map_file::kMapper),
      inboxes_{{mailbox_, max_waiting(config)}, {mailbox_, kMaxMessages}, {mailbox_, kMaxMessages}},
      map_services_(context, mailbox_, outputs_) {
  mapper_.report_progress_to([this] { beat(); });
  context.diagnostics.counter("corrections lost") = 0;  // told from the start
  context.diagnostics.warning("evidence", [this]() -> std::optional<std::string> {
    if (evidence_memory_.bytes_in_ram() == 0) return std::nullopt;
    return "the folder for temporary files (correction.spill_folder) has no room: evidence stays in memory";
  });
  if (!config.map_file.empty()) {
    auto start = read_start(config.map_file, map_commands::limits_of(config.maps), config.mapper);
    if (!start) throw std::runtime_error(start.error());
    mapper_.start_from(std::move(*start));
    outputs_.publish_all(mapper_, queue_.size());
  }
  go_on_from_checkpoint();
  subscribe();
  context.diagnostics.gauge("keyframes dropped",
                            [this] { return inboxes_.images.dropped() + queue_.dropped(); });
  context.diagnostics.counter("keyframes without a place") = 0;
}

/// The map as the process before this one had it, if it has left one.
void MapperService::go_on_from_checkpoint() {
  const auto keyframes = checkpoints_.restore(mapper_);
  if (!keyframes) {
    spdlog::warn("the map of the checkpoint is not used: {}", keyframes.error());
    return mapper_.reset(mapper_.map().epoch);
  }
  for (const IntegratedKeyframe& keyframe : *keyframes) {
    if (++integrated_ % kRestEvery == 0) evidence_memory_.rest();
  queue_.note_integrated(keyframe);
    outputs_.note_keyframe(keyframe.id, keyframe.stamp_ns);
  }
  if (keyframes->empty()) return;
  spdlog::info("goes on in a map of {} keyframes, epoch {:016x}", mapper_.archive().size(),
               mapper_.map().epoch);
  outputs_.publish_all(mapper_, queue_.size());
}

void MapperService::subscribe() {
  const auto waiting = [this] { return inboxes_.images.size() + queue_.size(); };
  context_.diagnostics.gauge("keyframes waiting", waiting);
  if (!config_.localize_only) {
    keyframe_source_.emplace(
        context_, topics::kMapper,
        [this](auto receiver) {
          return subscribe_to_instances(topics::kKeyframeImages, topics::kMapper, std::move(receiver));
        },
        [this](Images m) { inboxes_.images.push(std::move(m)); },
        [waiting] { return waiting() + keyframe_transfer::kRoom <= kMaxWaiting; });
    subscriptions_.push_back(topics::subscribe(context_.bus, topics::kBoxes, topics::kMapper,
                                               [this](Boxes m) { inboxes_.boxes.push(std::move(m)); }));
  }
  subscriptions_.push_back(subscribe_to_instances(topics::kKeyframePoses, topics::kMapper, [this](Poses m) {
    if (m->source() == messages::kPosesOfTracker && service::is_possible(*m, context_.diagnostics))
      inboxes_.poses.push(std::move(m));
  }));
}

void MapperService::run(const std::stop_token& stop) {
  stop_ = stop;
  while (wait(stop, [this] {
    const bool has_more_to_correct =
        !is_paused_ && (mapper_.is_correcting() || unplaced_.may_be_placed(poses_));
    return has_more_to_correct || !inboxes_.locked_empty() || !commands_.locked_empty() ||
           map_commands_.locked_ready() || map_services_.locked_ready();
  })) {
    handle_commands();
    map_commands_.settle();
    take_messages();
    idle();
  }
}

/// What may be due whether something has arrived or not.
void MapperService::idle() {
  if (mapper_.map().revision > 0 && !outputs_.is_busy() && outputs_.has_new_reader())
    outputs_.publish_all(mapper_, queue_.size());
  outputs_.refresh_views(mapper_);
  outputs_.share_map(mapper_);
  map_services_.settle(mapper_);
  if (is_paused_) return;
  guarded(topics::kKeyframePoses.name, [this] { correct(); });
  integrate_ready();
  integrate_placed(kPlacedAtOnce);
  checkpoints_.save(mapper_);
}

/// The map is another one: keyframes and poses of the one before are forgotten.
void MapperService::begin_map() {
  outputs_.begin_map();
  queue_.forget_keyframes();
  poses_ = {};
  unplaced_.clear();
}

/// Moves the map after a loop, and now and then after what local bundle adjustment has moved; a part of it
/// where that is much.
void MapperService::correct() {
  const bool is_due = poses_.is_correction_due();
  if (!is_due && !mapper_.is_correcting()) return;
  const auto started = std::chrono::steady_clock::now();
  MapDelta delta = is_due ? mapper_.apply_poses(poses_.poses()) : mapper_.go_on_correcting();
  if (is_due) poses_.note_correction();
  report_losses(mapper_.archive().lost(), config_.mapper.correction.spill_folder, context_.diagnostics);
  if (delta.is_noop()) return;
  outputs_.publish(std::move(delta), mapper_, queue_.size());
  context_.diagnostics.latency("correction").add_ms(ms_since(started));
}

void MapperService::integrate_ready() {
  while (queue_.is_ready())
    guarded(topics::kKeyframeImages.name, [this] {
      beat();
      integrate(queue_.take_oldest());
    });
}

/// Keyframes of a submap that was joined to the map.
void MapperService::integrate_placed(std::size_t most) {
  for (std::size_t i = 0; i < most && unplaced_.may_be_placed(poses_); ++i)
    if (const auto entry = unplaced_.take_placed(poses_))
      guarded(topics::kKeyframeImages.name, [&] {
        beat();
        integrate(*entry);
      });
  context_.diagnostics.counter("keyframes without a place") = unplaced_.size();
  context_.diagnostics.counter("keyframes without a place, dropped") = unplaced_.dropped();
}

void MapperService::integrate(const KeyframeQueue::Entry& entry) {
  if (UnplacedKeyframes::has_no_place(entry, poses_)) return unplaced_.hold(entry);
  const auto started = std::chrono::steady_clock::now();
  auto input = to_keyframe_input(entry.images);
  if (!input)
    return context_.diagnostics.reject(topics::kKeyframeImages.name, Rejection::kInvalid, input.error());
  const IntegratedKeyframe keyframe{input->id, input->stamp_ns, input->map_from_camera.inverse(),
                                    input->camera, entry.boxes != nullptr};
  if (entry.boxes)
    input->boxes = to_labelled_boxes(*entry.boxes, keyframe, config_.mapper, context_.diagnostics);
  if (const auto* known = poses_.find(keyframe.id)) input->map_from_camera = known->map_from_camera;
  MapDelta delta;
  try {
    delta = mapper_.integrate(*input);
  } catch (const std::invalid_argument& e) {
    return context_.diagnostics.reject(topics::kKeyframeImages.name, Rejection::kInvalid, e.what());
  }
  queue_.note_integrated(keyframe);
  poses_.note_keyframe();
  checkpoints_.add(keyframe);
  outputs_.note_keyframe(keyframe.id, keyframe.stamp_ns);
  report_losses(mapper_.archive().lost(), config_.mapper.correction.spill_folder, context_.diagnostics);
  outputs_.publish(std::move(delta), mapper_, queue_.size());
  context_.diagnostics.latency("keyframe").add_ms(ms_since(started));
}

}  // namespace rds::mapper
