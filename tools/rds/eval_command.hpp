// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace rds::tools {

/// `rds eval GROUNDTRUTH TRAJECTORY`: ATE and RPE of a trajectory, with a plot.
/// `rds eval DATASET OUT [--background DIR]`: the figures of a whole run.
///
/// The callback prints to stdout; on bad input it prints one sentence to stderr and throws
/// CLI::RuntimeError(2).
void add_eval_command(CLI::App& rds);

}  // namespace rds::tools
