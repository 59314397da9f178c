// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "common/map_file/folder.hpp"

namespace rds::map_file {

/// Maps have names, and lie below one folder of maps: FOLDER/NAME/map.rds, beside it what the mapper makes for
/// others (map.ot, objects.json, grid.pgm, grid.yaml).
///
/// A name has 1 to 64 of A-Z, a-z, 0-9, '.', '_' and '-', and does not begin with a dot; "checkpoints" is none.
/// @return or one sentence.
tl::expected<void, std::string> check_map_name(std::string_view name);

/// The folder of a map, opened without following links. @return or one sentence.
tl::expected<Folder, std::string> open_map(const std::filesystem::path& maps, const std::string& name);

struct MapSummary {
  std::string name;
  std::vector<std::string> parts;  // services that have a part in it; empty: its map.rds cannot be read
  std::uint64_t bytes = 0;         // of all its files
  std::int64_t saved_s = 0;        // since 1970
};

/// All maps below the folder of maps, by name. @return or one sentence, if the folder cannot be read.
tl::expected<std::vector<MapSummary>, std::string> list_maps(const std::filesystem::path& maps);

}  // namespace rds::map_file
