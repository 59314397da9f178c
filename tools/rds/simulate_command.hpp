// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace rds::tools {

/// `rds simulate --out DIR`: renders a recording of a furnished room with walking people, with its truth.
///
/// The callback prints progress to stdout; on bad usage it prints one sentence to stderr and throws
/// CLI::RuntimeError(2).
void add_simulate_command(CLI::App& rds);

}  // namespace rds::tools
