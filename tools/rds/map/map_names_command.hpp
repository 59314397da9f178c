// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <CLI/App.hpp>

#include "tools/rds/map/map_source.hpp"

namespace rds::tools {

/// Whether a user means a map by its name, not a file: without a slash, and without an ending of map files.
bool is_map_name(const std::string& text);

/// `rds map save NAME`: running services save their parts under this name.
void save_by_name(const MapSource& source, const std::string& name);

/// `rds map save FILE.rds`.
void save_as_file(const MapSource& source, const std::string& file);

/// Adds `rds map list` and `rds map load NAME`.
void add_map_names_commands(CLI::App& map);

}  // namespace rds::tools
