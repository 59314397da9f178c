// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace rds::secure {

/// `rds secure init FOLDER`: the certificates of a secured domain.
void add_secure_command(CLI::App& rds);

}  // namespace rds::secure
