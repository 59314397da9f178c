// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tools/rds/cli/bus_options.hpp"
#include "tools/rds/cli/exit.hpp"
#include "tools/rds/cli/interrupt.hpp"
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

/// Calls act(participant, timeout, stop) with the bus that running services are on. Ends the subcommand where
/// that is not possible or the answer is an error: kExitFault.
template <class Act>
auto on_the_bus(const MapSource& source, Act act) {
  const Interrupt interrupt;
  try {
    const auto participant = bus::Participant::create(source.bus.participant("rds_map"));
    auto done = act(*participant, std::chrono::duration<double>(source.timeout_s), interrupt.token());
    if (!done) exit_with(kExitFault, done.error());
    return done;
  } catch (const bus::BusError& e) {
    exit_with(kExitFault, e.what());
  }
}

/// Adds --timeout and those of the bus.
void add_live_options(CLI::App& command, MapSource& source);

/// From a map.ot, .bt, map.rds, or a folder that holds one of them. Ends the subcommand where there is none:
/// kExitBadInput.
LiveMap load_file(const std::filesystem::path& path);

/// The same, or the live map; kExitFault where that does not come in time.
LiveMap load(const MapSource& source);

}  // namespace rds::tools
