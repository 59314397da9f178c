// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace rds::tools {

/// `rds map merge A B OUT`: a saved map of two. CLI::RuntimeError(2) if they cannot be merged or written.
void add_map_merge_command(CLI::App& map);

}  // namespace rds::tools
