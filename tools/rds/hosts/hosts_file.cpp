// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/hosts/hosts_file.hpp"

#include <algorithm>
#include <array>
#include <climits>
#include <ranges>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "common/config/config_reader.hpp"
#include "tools/rds/topology/topology.hpp"

namespace rds::hosts {
namespace {

constexpr int kMaxDomain = 232;

std::vector<std::string> names_of(const HostsFile& hosts) {
  std::vector<std::string> names;
  for (const Machine& machine : hosts.machines) names.push_back(machine.name);
  return names;
}

/// Letters, digits and what stands between them in a host's name or address: it becomes a file's name, too.
bool is_name(const std::string& text) {
  return !text.empty() && text.front() != '.' && text.front() != '-' &&
         std::ranges::all_of(text, [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
         });
}

/// @param taken  services of the machines before.
Machine read_machine(config::ConfigReader& reader, const std::string& name, std::set<std::string>& taken) {
  Machine machine{name, name, {}};
  reader.value("address", machine.address);
  if (!is_name(machine.address))
    reader.violation("address", machine.address, "expected a name or an IPv4 address");
  std::vector<std::string> services;
  reader.value("services", services);
  for (const std::string& part : services) {
    const std::string service = run::service_of(part);
    if (service.empty())
      reader.violation("services", part, "expected tracker, detector, transformer, mapper or loop_closer");
    else if (!taken.insert(service).second)
      reader.violation("services", part, "expected each service once");
    else
      machine.services.insert(service);
  }
  return machine;
}

}  // namespace

const Machine& HostsFile::machine(const std::string& name) const {
  const auto found = std::ranges::find(machines, name, &Machine::name);
  if (found == machines.end())
    throw std::runtime_error(
        fmt::format("machine '{}': expected one of the hosts file: {}", name, fmt::join(names_of(*this), ", ")));
  return *found;
}

std::string HostsFile::peers_of(const std::string& name) const {
  std::vector<std::string> others;
  for (const Machine& machine : machines)
    if (machine.name != name) others.push_back(machine.address);
  return fmt::format("{}", fmt::join(others, ","));
}

std::set<std::string> HostsFile::services() const {
  std::set<std::string> all;
  for (const Machine& machine : machines) all.insert(machine.services.begin(), machine.services.end());
  return all;
}

HostsFile read_hosts_file(const std::filesystem::path& file) {
  auto reader = config::ConfigReader::from_file(file.string());
  HostsFile hosts;
  reader.value("domain", hosts.domain, 0, kMaxDomain);
  std::set<std::string> taken;
  auto& machines = reader.section("machines");
  for (const std::string& name : machines.keys()) {
    if (!is_name(name)) machines.violation(name, name, "expected a name of A-Z a-z 0-9 _ - .");
    hosts.machines.push_back(read_machine(machines.section(name), name, taken));
  }
  if (!taken.contains(run::kTracker)) reader.violation("machines", "no tracker", "expected a machine with the tracker");
  reader.finish();
  return hosts;
}

std::string this_machine(const HostsFile& hosts, const std::string& name) {
  if (!name.empty()) return hosts.machine(name).name;
  std::array<char, HOST_NAME_MAX + 1> own{};
  gethostname(own.data(), own.size() - 1);
  const std::string all = own.data();
  for (const std::string& candidate : {all, all.substr(0, all.find('.'))})
    for (const Machine& machine : hosts.machines)
      if (candidate == machine.name || candidate == machine.address) return machine.name;
  throw std::runtime_error(fmt::format("this computer is called '{}': expected --machine with one of {}", all,
                                       fmt::join(names_of(hosts), ", ")));
}

}  // namespace rds::hosts
