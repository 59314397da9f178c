// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "tools/rds/run/services/fleet.hpp"
#include "tools/rds/run/services/run_options.hpp"

namespace rds::run {

/// Below the folder of a run, while it lasts: the services' folder of maps.
inline const std::string kMapsFolder = "maps";

/// The services of a run, on whichever machine.
std::set<std::string> services_of(const RunOptions& options);

/// How to start the services of a run that run here, each with its own configuration file in `folder`/config.
///
/// A service's configuration is its section of the user's --config file (tracker, detector, transformer,
/// mapper, loop_closer), completed with what the command line says.
/// @throws std::runtime_error, config::ConfigError with one sentence for a file or section that is not
/// understood.
std::vector<ServiceCommand> service_commands(const RunOptions& options, int domain,
                                             const std::filesystem::path& folder);

/// How to start the viewer of the run. @pre options.view is given. @throws as service_commands().
ServiceCommand viewer_command(const RunOptions& options, int domain, const std::filesystem::path& folder);

}  // namespace rds::run
