// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "common/map_file/folder.hpp"
#include "common/map_file/map_file.hpp"

namespace rds::map_file {

inline const std::string kMapFile = "map.rds";

/// Names of the sections. The tracker writes the first two: keyframe poses are what all agree on.
inline const std::string kKeyframePoses = "keyframe_poses";
inline const std::string kTracker = "tracker";
inline const std::string kMapper = "mapper";
inline const std::string kLoopCloser = "loop_closer";

/// The services that have a part of the map; each writes the section of its name.
inline const std::array<std::string, 3> kParts{kTracker, kMapper, kLoopCloser};

/// A saved map from what a user names: the file, or a folder that holds map.rds. @return or one sentence.
tl::expected<Sections, std::string> read_saved_map(const std::filesystem::path& path,
                                                   const FileLimits& limits = {});

/// The same, of which these sections must be there.
tl::expected<Sections, std::string> read_saved_map(const std::filesystem::path& path,
                                                   const std::vector<std::string>& needed,
                                                   const FileLimits& limits = {});

/// map.rds of a map that was opened by its name, of which these sections must be there.
tl::expected<Sections, std::string> read_saved_map(const Folder& map, const std::vector<std::string>& needed,
                                                   const FileLimits& limits);

}  // namespace rds::map_file
