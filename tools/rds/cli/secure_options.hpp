// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "common/bus/security.hpp"

namespace rds {

/// As whom a tool takes part in a secured domain.
struct SecureOptions {
  std::string folder = {};                                   // empty: the bus is open
  std::string identity = {};                                 // empty: the first of `identities` that is there
  std::vector<std::string> identities{"operator", "reader"};  // the tool's own choice

  /// @return nothing on an open bus. @throws std::runtime_error with one sentence if they cannot be used.
  [[nodiscard]] std::optional<bus::Credentials> credentials() const;
};

/// Adds --secure (default: RDS_SECURE) and --identity (default: RDS_IDENTITY).
void add_secure_options(CLI::App& command, SecureOptions& options);

}  // namespace rds
