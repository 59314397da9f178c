// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace rds::tools {

/// Runs a script of tools/networks with `folder` as its argument and waits for it; its output goes where ours
/// goes.
///
/// The scripts are looked up in $RDS_NETWORK_SCRIPTS, in ../share/rds-slam/networks beside the program's
/// folder, and in the source tree that the program was built from.
/// @throws detector::DetectorError if the script is not found or fails.
void run_network_script(const std::string& name, const std::filesystem::path& folder);

}  // namespace rds::tools
