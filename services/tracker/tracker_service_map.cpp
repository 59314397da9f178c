// SPDX-License-Identifier: Apache-2.0
// The part of TrackerService that saves the map and goes on in a saved one.
#include <spdlog/spdlog.h>

#include "common/map_file/geometry_bytes.hpp"
#include "common/map_file/saved_map.hpp"
#include "services/tracker/core/map_bytes.hpp"
#include "services/tracker/tracker_service.hpp"

namespace rds::tracker {

/// Reads what the next epoch begins with; after a fault everything is as before.
tl::expected<void, std::string> TrackerService::read_start(const std::filesystem::path& saved_map) {
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected(fmt::format("{}: cannot be tracked in: {}", saved_map.string(), why));
  };
  const auto sections = map_file::read_saved_map(saved_map, {map_file::kTracker, map_file::kKeyframePoses});
  if (!sections) return tl::unexpected(sections.error());
  const auto poses = map_file::keyframe_poses_from_bytes(sections->at(map_file::kKeyframePoses));
  if (!poses) return refuse(poses.error());
  auto map = map_from_bytes(sections->at(map_file::kTracker), *poses, config_.tracker);
  if (!map) return refuse(map.error());
  start_ = std::move(*map);
  return {};
}

void TrackerService::start_map() {
  if (!start_) return;
  tracker_.start_from(SavedMap(*start_));
  spdlog::info("goes on in a map of {} keyframes and {} points", tracker_.map().keyframes(),
               tracker_.map().points());
}

service::CommandOutcome TrackerService::save(const std::string& folder) const {
  const SlamMap& map = tracker_.map();
  const auto written = map_file::write_map_file(
      map_file::service_file(folder, map_file::kTracker),
      {{map_file::kTracker, to_bytes(map, tracker_.known_camera(), config_.tracker.extraction)},
       {map_file::kKeyframePoses, map_file::to_bytes(map.keyframe_poses())}});
  if (!written) return {false, written.error()};
  return {true,
          fmt::format("{} keyframes and {} points written to {}", map.keyframes(), map.points(), folder)};
}

service::CommandOutcome TrackerService::load(const std::string& saved_map) {
  if (!config_.poses_file.empty()) return {false, "poses are given by poses_file, which know no saved map"};
  if (const auto read = read_start(saved_map); !read) return {false, read.error()};
  reset();
  return {true, fmt::format("map of {} keyframes, epoch {:016x}", tracker_.map().keyframes(), map_epoch_)};
}

}  // namespace rds::tracker
