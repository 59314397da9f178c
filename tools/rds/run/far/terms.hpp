// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "tools/rds/hosts/hosts_file.hpp"
#include "tools/rds/run/services/run_options.hpp"

namespace rds::run {

/// How a machine has to do its part of a run, from the machine with the camera: what the command line says
/// there, and the settings. Which files a service reads (network, saved map, detections) each machine says
/// for itself.
/// @param run  random: tells this run from others. @return JSON.
std::string terms_of(const RunOptions& options, const hosts::HostsFile& hosts, const std::string& machine,
                     const std::string& run);

/// Puts the terms into a machine's own options.
/// @param folder  where the settings are written.
/// @throws std::runtime_error with one sentence if this machine cannot do that.
void accept_terms(const std::string& terms, const hosts::Machine& machine,
                         const std::filesystem::path& folder, RunOptions& options);

/// On the machine with the camera: every service of the run has a machine, and no file that is named on this
/// one's command line is for a service on another.
/// @throws std::runtime_error with one sentence.
void check_placement(const RunOptions& options, const hosts::HostsFile& hosts, const hosts::Machine& here);

}  // namespace rds::run
