// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace rds::hosts {

/// A machine and the services that run there.
struct Machine {
  std::string name;
  std::string address;             // name or IPv4 address by which the others reach it
  std::set<std::string> services;  // "rds-tracker", ...

  bool operator==(const Machine&) const = default;
};

/// Which service runs where. The camera is where the tracker is.
struct HostsFile {
  int domain = 0;
  std::vector<Machine> machines;

  /// @throws std::runtime_error if there is none of this name.
  [[nodiscard]] const Machine& machine(const std::string& name) const;
  /// Addresses of all machines but this one, with commas.
  [[nodiscard]] std::string peers_of(const std::string& name) const;
  [[nodiscard]] std::set<std::string> services() const;

  bool operator==(const HostsFile&) const = default;
};

/// Reads, for example,
///
///     domain: 7                     # 0 where it is left out
///     machines:
///       robot: {address: 10.0.0.1, services: [tracker]}
///       desk: {services: [detector, transformer, mapper, loop_closer]}   # reached by its name
///
/// @throws config::ConfigError with a sentence for each violation: every service stands at most once, and the
/// tracker does.
HostsFile read_hosts_file(const std::filesystem::path& file);

/// The machine that this is. @param name  empty: the one with the name of this computer.
/// @throws std::runtime_error if the file has no such machine.
std::string this_machine(const HostsFile& hosts, const std::string& name);

}  // namespace rds::hosts
