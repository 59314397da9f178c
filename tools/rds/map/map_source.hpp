// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tools/rds/cli/bus_options.hpp"
#include "tools/rds/map/live_map.hpp"

namespace rds::tools {

/// Where a map comes from.
struct MapSource {
  BusOptions bus;
  double timeout_s = 10;
  std::string file;  // empty: the live map

  [[nodiscard]] bool is_live() const { return file.empty(); }
  [[nodiscard]] std::string name() const { return is_live() ? "live" : file; }
};

/// Adds --timeout and those of the bus.
void add_live_options(CLI::App& command, MapSource& source);

/// From a map.ot, .bt, map.rds, or a folder that holds one of them. Ends the subcommand where there is none:
/// kExitBadInput.
LiveMap load_file(const std::filesystem::path& path);

/// The same, or the live map; kExitFault where that does not come in time.
LiveMap load(const MapSource& source);

}  // namespace rds::tools
