// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace rds::tools {

/// `rds map info|save|export|query`: a map from a file (--map map.ot) or, without it, the one on the live
/// bus. `rds map diff`: map_diff_command.hpp.
///
/// The callbacks print to stdout. A file that cannot be read or written: one sentence to stderr and
/// CLI::RuntimeError(2); no map on the bus in time: CLI::RuntimeError(1).
void add_map_command(CLI::App& rds);

}  // namespace rds::tools
