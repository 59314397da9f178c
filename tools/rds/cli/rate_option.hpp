// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace rds {

/// Adds --rate: a positive number, or "max", which becomes 0.
void add_rate_option(CLI::App& command, double& rate);

}  // namespace rds
