// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace rds::run {

/// Adds `rds run`: the whole chain on one recording.
void add_run_command(CLI::App& rds);

}  // namespace rds::run
