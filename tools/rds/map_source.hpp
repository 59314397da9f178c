// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/rds/bus_options.hpp"
#include "tools/rds/live_map.hpp"

namespace rds::tools {

/// Where a map comes from.
struct MapSource {
  BusOptions bus;
  double timeout_s = 10;
  std::string file;  // map.ot, .bt, map.rds, or a folder that holds one of them; empty: the live map

  [[nodiscard]] bool is_live() const { return file.empty(); }
  [[nodiscard]] std::string name() const { return is_live() ? "live" : file; }
};

/// Adds --timeout and those of the bus.
void add_live_options(CLI::App& command, MapSource& source);

/// Ends the subcommand where there is none: kExitBadInput for a file, kExitFault for the live map.
LiveMap load(const MapSource& source);

}  // namespace rds::tools
