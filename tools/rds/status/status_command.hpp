// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace rds::tools {

/// Adds `rds status`: which services are on the bus and whether they are well.
void add_status_command(CLI::App& rds);

}  // namespace rds::tools
