// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/map_file/folder.hpp"
#include "common/map_file/regular_file.hpp"
#include "services/mapper/core/saved_map.hpp"

namespace rds::mapper {

/// A saved map, or OctoMap's tree, that a user names: map.rds, its folder, or a .ot or .bt file.
ReadMap read_start(const std::filesystem::path& from, const map_file::FileLimits& limits,
                   const MapperConfig& config);

/// A map that was opened by its name; of one that only OctoMap knows, its map.ot.
ReadMap read_start(const map_file::Folder& map, const map_file::FileLimits& limits,
                   const MapperConfig& config);

}  // namespace rds::mapper
