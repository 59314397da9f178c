// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace rds::doctor {

/// `rds doctor`: is this machine ready? `rds doctor --dataset DIR`: is this recording fit to be run?
///
/// The callback prints a line per finding; with a fault among them it throws CLI::RuntimeError(1), for a
/// dataset that cannot be opened it prints one sentence to stderr and throws CLI::RuntimeError(2).
void add_doctor_command(CLI::App& rds);

}  // namespace rds::doctor
