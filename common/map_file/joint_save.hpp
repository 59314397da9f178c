// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/map_file/saved_map.hpp"

namespace rds::map_file {

/// One save that several services carry out, each with its part of the map.
struct SaveOrder {
  std::string name;                // of the map
  std::string id;                  // of this save, in all of its parts: 1 to 64 of A-Z a-z 0-9 _ -
  std::vector<std::string> parts;  // some of kParts: together they are the map

  bool operator==(const SaveOrder&) const = default;
};

/// @return nothing, or one sentence: what is wrong with it.
tl::expected<void, std::string> check(const SaveOrder& order);

/// What one service gives to a save.
struct MapPart {
  std::string name;  // one of kParts
  Sections sections;
  std::map<std::string, Bytes> files;  // for others, to lie beside map.rds
};

enum class SaveState {
  kWaits,      // for other parts
  kPublished,  // this part was the last one: the map has its name
  kComplete,   // another service, whose part came at the same time, publishes it
};

/// Writes a part of a map to FOLDER/.saving/NAME.ID. The last part makes map.rds of all, and publishes the
/// folder as FOLDER/NAME: all parts of one save, or none. A map that had the name before is replaced in one
/// step. Saves that were never completed are removed by the next save ten minutes later.
///
/// @return or one sentence, and then nothing is left of this save: no room, a deadline, a part that is
/// missing, damaged or of another save.
tl::expected<SaveState, std::string> save_part(const std::filesystem::path& maps, const SaveOrder& order,
                                               MapPart part, const FileLimits& limits);

}  // namespace rds::map_file
