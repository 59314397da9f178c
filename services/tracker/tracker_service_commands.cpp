// SPDX-License-Identifier: Apache-2.0
// The commands of TrackerService.
#include <memory>

#include <nlohmann/json.hpp>

#include "services/tracker/saved_start.hpp"
#include "services/tracker/tracker_service.hpp"

namespace rds::tracker {

/// Saves the map, or begins a new map epoch with a saved one; after a fault everything is as before.
bool TrackerService::begin(const service::PendingCommand& command) {
  if (command.verb == "save") {
    map_commands_.save(
        command, [this] { return epoch_.part(); }, epoch_.description());
    return true;
  }
  if (command.verb != "load") return false;
  if (!config_.poses_file.empty()) {
    command.answer({false, "poses are given by poses_file, which know no saved map"});
    return true;
  }
  const auto read = [this, config = config_.tracker](const map_file::Folder& map, const auto& limits)
      -> tl::expected<map_commands::MapCommands::Completion, std::string> {
    auto saved = read_saved_start(map, limits, config);
    if (!saved) return tl::unexpected(saved.error());
    const auto start = std::make_shared<SavedMap>(std::move(saved->map));
    return [this, start] {
      epoch_.renew_in(std::move(*start));
      return begin_epoch();
    };
  };
  map_commands_.load(command, read);
  return true;
}

service::CommandOutcome TrackerService::execute(const std::string& verb, const std::string& /*argument*/) {
  if (verb == "finish") return finish();
  if (verb == "reset") return reset();
  if (verb == "pause" || verb == "resume") {
    paused_ = verb == "pause";
    return {true, paused_ ? "paused" : "resumed"};
  }
  return unknown_command(verb);
}

void TrackerService::reconfigure(const TrackerServiceConfig& config) {
  outputs_.odometry().publish_tf(config.frames.publish_tf);
  tracker_.set_keyframes(config.tracker.keyframe);
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
      answers_.await(frame_index_, epoch_.id(), stop_, [this] { beat(); });
      apply_answers();
      start_mapping();
    }
  } else {
    apply_answers();
  }
  frame_index_ = last_frame;
  const auto poses = tracker_.keyframe_poses();
  const std::uint64_t revision = outputs_.publish_poses(poses, epoch_.loops(), true);
  const std::size_t in_map = config_.tracker.localize_only ? 0 : poses.size();
  return {true, nlohmann::json{{"poses_revision", revision},
                               {"keyframes", in_map},
                               {"keyframes_in_map", tracker_.map().keyframes().size()}}
                    .dump()};
}

service::CommandOutcome TrackerService::reset() {
  epoch_.renew();
  return begin_epoch();
}

/// Forgets all that was of the epoch before.
service::CommandOutcome TrackerService::begin_epoch() {
  objects_.reset();
  ++place_;
  outputs_.set_epoch(epoch_.id());
  answers_.clear();
  return {true,
          fmt::format("map of {} keyframes, epoch {:016x}", tracker_.map().keyframes().size(), epoch_.id())};
}

}  // namespace rds::tracker
