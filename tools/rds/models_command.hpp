// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "services/detector/models/model_store.hpp"

namespace rds::tools {

/// One line per shipped network: default marker, name, its file's place or "missing", licence.
void list_models(std::ostream& out, const detector::ModelFolders& folders);

/// Puts the files of the named networks (none: all that can be fetched) into the user's cache.
/// @throws detector::DetectorError if one cannot be fetched.
void fetch_models(std::ostream& out, const std::vector<std::string>& names);

/// Verifies the named networks' files (none: all that are found) by SHA-256 and by computing each once.
/// @throws detector::DetectorError naming the first that is not right, after all have been looked at; or if
/// none is found.
void check_models(std::ostream& out, const std::vector<std::string>& names,
                  const detector::ModelFolders& folders);

}  // namespace rds::tools
