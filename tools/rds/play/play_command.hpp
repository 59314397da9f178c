// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace rds::play {

/// Adds `rds play`: publishes a recording as a camera would.
void add_play_command(CLI::App& rds);

}  // namespace rds::play
