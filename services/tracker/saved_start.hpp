// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <tl/expected.hpp>

#include "common/map_file/folder.hpp"
#include "common/map_file/map_file.hpp"
#include "services/tracker/core/config/tracker_config.hpp"
#include "services/tracker/core/map/map_bytes.hpp"

namespace rds::tracker {

/// A saved map to go on in.
struct SavedStart {
  SavedMap map;
  std::uint64_t checksum = 0;  // of the tracker's part
};

/// Reads it from a file or folder that a user names. @return or one sentence.
tl::expected<SavedStart, std::string> read_saved_start(const std::filesystem::path& path,
                                                       const map_file::FileLimits& limits,
                                                       const TrackerConfig& config);
/// The same from a map that was opened by its name.
tl::expected<SavedStart, std::string> read_saved_start(const map_file::Folder& map,
                                                       const map_file::FileLimits& limits,
                                                       const TrackerConfig& config);

}  // namespace rds::tracker
