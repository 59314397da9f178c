// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "common/map_file/saved_map.hpp"
#include "services/tracker/core/map/map_bytes.hpp"
#include "services/tracker/tracker_service_config.hpp"

namespace rds::tracker {

/// Sections of a saved map that the tracker needs.
inline const std::vector<std::string> kNeededSections{map_file::kTracker, map_file::kKeyframePoses};

/// The map that map epochs begin with, from a saved one. @param from  to be named in the sentence.
/// @return or one sentence.
tl::expected<SavedMap, std::string> to_start(const map_file::Sections& sections, const TrackerConfig& config,
                                             const std::filesystem::path& from);

/// The map of the setting map_file, and the checksum of the tracker's part.
struct Start {
  SavedMap map;
  std::uint64_t checksum = 0;
};

/// @throws std::runtime_error with one sentence.
Start read_start_or_throw(const TrackerServiceConfig& config);

}  // namespace rds::tracker
