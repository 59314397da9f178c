// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/saved_start.hpp"

#include <fmt/format.h>

#include "common/map_file/checksum.hpp"
#include "common/map_file/geometry_bytes.hpp"
#include "common/map_file/saved_map.hpp"

namespace rds::tracker {
namespace {

const std::vector<std::string> kNeededSections{map_file::kTracker, map_file::kKeyframePoses};

tl::expected<SavedStart, std::string> start_of(const tl::expected<map_file::Sections, std::string>& sections,
                                               const TrackerConfig& config,
                                               const std::filesystem::path& from) {
  if (!sections) return tl::unexpected(sections.error());
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected(fmt::format("{}: cannot be tracked in: {}", from.string(), why));
  };
  const auto poses = map_file::keyframe_poses_from_bytes(sections->at(map_file::kKeyframePoses));
  if (!poses) return refuse(poses.error());
  auto map = map_from_bytes(sections->at(map_file::kTracker), *poses, config.extraction);
  if (!map) return refuse(map.error());
  return SavedStart{std::move(*map), map_file::checksum_of(sections->at(map_file::kTracker))};
}

}  // namespace

tl::expected<SavedStart, std::string> read_saved_start(const std::filesystem::path& path,
                                                       const map_file::FileLimits& limits,
                                                       const TrackerConfig& config) {
  return start_of(map_file::read_saved_map(path, kNeededSections, limits), config, path);
}

tl::expected<SavedStart, std::string> read_saved_start(const map_file::Folder& map,
                                                       const map_file::FileLimits& limits,
                                                       const TrackerConfig& config) {
  return start_of(map_file::read_saved_map(map, kNeededSections, limits), config, map.path());
}

}  // namespace rds::tracker
