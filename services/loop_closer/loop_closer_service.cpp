// SPDX-License-Identifier: Apache-2.0
#include "services/loop_closer/loop_closer_service.hpp"

#include <chrono>
#include <limits>

#include <spdlog/spdlog.h>

#include "common/map_file/checksum.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "common/map_file/saved_map.hpp"
#include "common/service/checkpoints.hpp"
#include "services/loop_closer/feature_message.hpp"

namespace rds::loop_closer {
namespace {
// As many as the bus keeps: one that starts late, or again, meets them all at once.
constexpr std::size_t kMaxWaiting = bus::kKeyframeFeatures.max_samples;
}  // namespace

LoopCloserService::LoopCloserService(service::ServiceContext& context, const LoopCloserServiceConfig& config)
    : Service(context),
      tracker_(context.bus, service::kTracker),
      loop_closer_(config.loop_closer),
      checkpoints_(
          config.localize_only ? nullptr : service::open_checkpoints(context, config.maps, "loop_closer"),
          config.maps.checkpoint_s),
      map_commands_(mailbox_, config.maps, map_file::kLoopCloser),
      answers_(context),
      is_read_only_(config.localize_only),
      features_(mailbox_, config.lockstep ? std::numeric_limits<std::size_t>::max() : kMaxWaiting) {
  if (!config.map_file.empty()) read_start(config);
  go_on_from_checkpoint();
  keyframe_source_.emplace(
      context, topics::kLoopCloser,
      [this](auto receiver) {
        return subscribe_to_instances(topics::kKeyframeFeatures, topics::kLoopCloser, std::move(receiver));
      },
      [this](Features m) { features_.push(std::move(m)); },
      [this] { return features_.size() + keyframe_transfer::kRoom <= kMaxWaiting; });
  context.diagnostics.gauge("keyframes", [this] { return keyframes_.load(); });
  context.diagnostics.gauge("keyframes waiting", [this] { return features_.size(); });
  context.diagnostics.gauge("keyframes dropped", [this] { return features_.dropped(); });
}

/// @throws std::runtime_error with one sentence.
void LoopCloserService::read_start(const LoopCloserServiceConfig& config) {
  const auto sections = map_file::read_saved_map(config.map_file, {map_file::kKeyframePoses},
                                                 map_commands::limits_of(config.maps));
  if (!sections) throw std::runtime_error(sections.error());
  if (const auto started = start_from(*sections, config.map_file); !started)
    throw std::runtime_error(started.error());
}

/// With the keyframes that the process before this one knew; nothing of it is published.
void LoopCloserService::go_on_from_checkpoint() {
  if (const auto restored = checkpoints_.restore(loop_closer_); !restored) {
    spdlog::warn("the keyframes of the checkpoint are not used: {}", restored.error());
    loop_closer_.reset();
    return checkpoints_.clear();
  }
  keyframes_ = loop_closer_.keyframes();
  const auto& last = checkpoints_.restored();
  if (!last) return;
  answers_.begin(last->map_epoch);
  spdlog::info("goes on with {} keyframes, epoch {:016x}", loop_closer_.keyframes(), last->map_epoch);
}

void LoopCloserService::run(const std::stop_token& stop) {
  while (wait(stop, [this] {
    return !features_.locked_empty() || !commands_.locked_empty() || map_commands_.locked_ready();
  })) {
    handle_commands();
    map_commands_.settle();
    if (const auto features = features_.try_pop())
      guarded(topics::kKeyframeFeatures.name, [&] { take(*features); });
    checkpoints_.save();
  }
}

/// A keyframe that the bus still has, and the checkpoint had.
bool LoopCloserService::is_known(const Features& features) const {
  const auto& last = checkpoints_.restored();
  return last && features->map_epoch() == last->map_epoch && features->keyframe_id() <= last->id;
}

/// Where there are keyframes to lose, another epoch begins with its second one; the first is answered, and
/// waits.
bool LoopCloserService::is_confirmed(const Features& features) {
  const bool goes_on = features->map_epoch() == answers_.map_epoch();
  if (goes_on) another_epoch_.deny();
  if (goes_on || loop_closer_.keyframes() == 0) return true;
  if (!another_epoch_.confirm(features->instance(), features->map_epoch(), features->keyframe_id())) {
    first_of_epoch_ = features;
    answers_.acknowledge(features);
    return false;
  }
  const Features first = std::exchange(first_of_epoch_, nullptr);
  if (first && first->map_epoch() == features->map_epoch()) {
    answers_.begin(first->map_epoch());
    take(first);
  }
  return true;
}

void LoopCloserService::take(const Features& features) {
  if (!tracker_.accept(features->instance(), features->map_epoch() == answers_.map_epoch()))
    return context_.diagnostics.reject(topics::kKeyframeFeatures.name, service::Rejection::kForeign,
                                       "another tracker");
  if (!is_confirmed(features)) return;
  if (is_known(features) && features->keyframe_id() < checkpoints_.restored()->id) return;
  if (paused_ || is_known(features))
    return answers_.answer(features, {});  // the last one's may be waited for
  const auto started = std::chrono::steady_clock::now();
  auto keyframe = to_keyframe_features(*features);
  if (!keyframe)
    return context_.diagnostics.reject(topics::kKeyframeFeatures.name, service::Rejection::kInvalid,
                                       keyframe.error());
  keyframe->follows = loop_closer_.revision() == 0 || (features->loop_instance() == context_.instance &&
                                                       features->loop_revision() == loop_closer_.revision());
  const LoopAnswer found = loop_closer_.add(*keyframe);
  if (found.refused.empty()) checkpoints_.add(*keyframe);
  keyframes_ = loop_closer_.keyframes();
  if (!found.refused.empty())
    context_.diagnostics.reject(topics::kKeyframeFeatures.name, service::Rejection::kInvalid, found.refused);
  if (!found.poses.empty()) spdlog::info("keyframe {} closes loop {}", found.keyframe_id, found.loops_closed);
  answers_.answer(features, found);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - started;
  context_.diagnostics.latency("keyframe").add_ms(took.count());
}

void LoopCloserService::forget() {
  answers_.begin();
  checkpoints_.clear();
  keyframes_ = loop_closer_.keyframes();
}

service::CommandOutcome LoopCloserService::execute(const std::string& verb, const std::string& /*argument*/) {
  if (verb == "reset") {
    loop_closer_.reset();
    forget();
    return {true, "forgot all keyframes since the start"};
  }
  if (verb == "pause" || verb == "resume") {
    paused_ = verb == "pause";
    return {true, paused_ ? "paused" : "resumed"};
  }
  return unknown_command(verb);
}

tl::expected<void, std::string> LoopCloserService::start_from(const map_file::Sections& saved,
                                                              const std::filesystem::path& from) {
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected(fmt::format("{}: loops cannot be closed to it: {}", from.string(), why));
  };
  const auto own = saved.find(map_file::kLoopCloser);
  if (own == saved.end()) {
    spdlog::warn("{}: was saved without a loop closer, so none of its keyframes is known", from.string());
    return {};
  }
  const auto poses = map_file::keyframe_poses_from_bytes(saved.at(map_file::kKeyframePoses));
  if (!poses) return refuse(poses.error());
  if (const auto started = loop_closer_.start_from(own->second, *poses); !started)
    return refuse(started.error());
  checkpoints_.begin_with(map_file::checksum_of(own->second));
  answers_.begin();
  return {};
}

/// `save` and `load`; from a map that cannot be read or does not fit nothing is taken over.
bool LoopCloserService::begin(const service::PendingCommand& command) {
  if (command.verb == "save") {
    map_commands_.save(
        command,
        [this]() -> map_file::MapPart {
          return {map_file::kLoopCloser,
                  {{map_file::kLoopCloser,
                    is_read_only_ ? loop_closer_.start_to_bytes() : loop_closer_.to_bytes()}},
                  {}};
        },
        "keyframes");
    return true;
  }
  if (command.verb != "load") return false;
  using map_commands::MapCommands;
  map_commands_.load(
      command,
      [this](const map_file::Folder& map,
             const map_file::FileLimits& limits) -> tl::expected<MapCommands::Completion, std::string> {
        auto sections = map_file::read_saved_map(map, {map_file::kKeyframePoses}, limits);
        if (!sections) return tl::unexpected(sections.error());
        const auto read = std::make_shared<map_file::Sections>(std::move(*sections));
        return [this, read, from = map.path()]() -> service::CommandOutcome {
          if (const auto started = start_from(*read, from); !started) return {false, started.error()};
          forget();
          return {true, "keyframes of " + from.filename().string()};
        };
      });
  return true;
}

}  // namespace rds::loop_closer
