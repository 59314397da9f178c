// SPDX-License-Identifier: Apache-2.0
// The part of TrackerService that saves the map and goes on in a saved one.
#include <spdlog/spdlog.h>

#include "common/map_file/geometry_bytes.hpp"
#include "services/tracker/core/map/map_bytes.hpp"
#include "services/tracker/saved_start.hpp"
#include "services/tracker/tracker_service.hpp"

namespace rds::tracker {

bool TrackerService::begin(const service::PendingCommand& command) {
  if (command.verb == "load") {
    load(command);
  } else if (command.verb == "save") {
    const SlamMap& map = tracker_.map();
    map_commands_.save(
        command, [this] { return map_part(); },
        fmt::format("{} keyframes and {} points", map.keyframes(), map.points()));
  } else {
    return false;
  }
  return true;
}

void TrackerService::start_map() {
  if (!start_) return;
  tracker_.start_from(SavedMap(*start_));
  spdlog::info("goes on in a map of {} keyframes and {} points", tracker_.map().keyframes(),
               tracker_.map().points());
}

/// Goes on in the map, and the epoch, of the process before this one, if it has left a checkpoint.
void TrackerService::go_on_from_checkpoint() {
  const auto epoch = checkpoints_.restore(start_checksum_, tracker_);
  if (!epoch) spdlog::warn("the map of the checkpoint is not used: {}", epoch.error());
  if (!epoch || !*epoch) return checkpoints_.clear();
  map_epoch_ = (*epoch)->map_epoch;
  loops_ = (*epoch)->loops;
  outputs_.set_epoch(map_epoch_);
  resume_.begin();
  spdlog::info("goes on in a map of {} keyframes and {} points", tracker_.map().keyframes(),
               tracker_.map().points());
  publish_poses();
}

void TrackerService::save_checkpoint() {
  checkpoints_.save(tracker_, {map_epoch_, start_checksum_, loops_});
}

map_file::MapPart TrackerService::map_part() const {
  const SlamMap& map = tracker_.map();
  return {
      map_file::kTracker,
      {{map_file::kTracker, to_bytes(map, tracker_.calibration().known_camera(), config_.tracker.extraction)},
       {map_file::kKeyframePoses, map_file::to_bytes(map.keyframe_poses())}},
      {}};
}

/// Begins a new map epoch with a saved map; after a fault everything is as before.
void TrackerService::load(const service::PendingCommand& command) {
  if (!config_.poses_file.empty())
    return command.answer({false, "poses are given by poses_file, which know no saved map"});
  using map_commands::MapCommands;
  const auto begin_with = [this](SavedMap saved) -> service::CommandOutcome {
    start_ = std::move(saved);
    reset();
    return {true, fmt::format("map of {} keyframes, epoch {:016x}", tracker_.map().keyframes(), map_epoch_)};
  };
  map_commands_.load(
      command,
      [config = config_.tracker, begin_with](const map_file::Folder& map, const map_file::FileLimits& limits)
          -> tl::expected<MapCommands::Completion, std::string> {
        const auto sections = map_file::read_saved_map(map, kNeededSections, limits);
        if (!sections) return tl::unexpected(sections.error());
        auto start = to_start(*sections, config, map.path());
        if (!start) return tl::unexpected(start.error());
        const auto read = std::make_shared<SavedMap>(std::move(*start));
        return [read, begin_with] { return begin_with(std::move(*read)); };
      });
}

}  // namespace rds::tracker
