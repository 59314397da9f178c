// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/cli/secure_options.hpp"

#include <algorithm>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

namespace rds {
namespace {

/// The first whose key this user may read.
std::string chosen_identity(const SecureOptions& options) {
  if (!options.identity.empty()) return options.identity;
  const std::filesystem::path folder = options.folder;
  const auto usable = [&](const std::string& name) {
    return access((folder / name / bus::kKeyFile).c_str(), R_OK) == 0;
  };
  const auto found = std::ranges::find_if(options.identities, usable);
  return found == options.identities.end() ? options.identities.front() : *found;
}

}  // namespace

std::optional<bus::Credentials> SecureOptions::credentials() const {
  if (folder.empty()) return std::nullopt;
  auto read = bus::read_credentials(folder, chosen_identity(*this));
  if (!read) throw std::runtime_error(read.error());
  return std::move(*read);
}

void add_secure_options(CLI::App& command, SecureOptions& options) {
  command.add_option("--secure", options.folder, "Folder of rds secure init, for a secured domain")
      ->envname("RDS_SECURE");
  command
      .add_option("--identity", options.identity,
                  fmt::format("Which of its parts (default: {}, what is there)",
                              fmt::join(options.identities, " or ")))
      ->envname("RDS_IDENTITY");
}

}  // namespace rds
