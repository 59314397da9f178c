// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace rds::tools {

/// `rds map diff A [B]`: a saved map and another one, or the live one.
///
/// CLI::RuntimeError(1) if they differ or there is no live map in time, (2) if a file cannot be read or the
/// voxels are of different sizes.
void add_map_diff_command(CLI::App& map);

}  // namespace rds::tools
