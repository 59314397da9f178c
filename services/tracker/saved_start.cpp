// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/saved_start.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "common/map_commands/map_commands.hpp"
#include "common/map_file/checksum.hpp"
#include "common/map_file/geometry_bytes.hpp"

namespace rds::tracker {

tl::expected<SavedMap, std::string> to_start(const map_file::Sections& sections, const TrackerConfig& config,
                                             const std::filesystem::path& from) {
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected(fmt::format("{}: cannot be tracked in: {}", from.string(), why));
  };
  const auto poses = map_file::keyframe_poses_from_bytes(sections.at(map_file::kKeyframePoses));
  if (!poses) return refuse(poses.error());
  auto map = map_from_bytes(sections.at(map_file::kTracker), *poses, config.map, config.extraction);
  if (!map) return refuse(map.error());
  return map;
}

Start read_start_or_throw(const TrackerServiceConfig& config) {
  const auto sections =
      map_file::read_saved_map(config.map_file, kNeededSections, map_commands::limits_of(config.maps));
  if (!sections) throw std::runtime_error(sections.error());
  auto start = to_start(*sections, config.tracker, config.map_file);
  if (!start) throw std::runtime_error(start.error());
  return {std::move(*start), map_file::checksum_of(sections->at(map_file::kTracker))};
}

}  // namespace rds::tracker
