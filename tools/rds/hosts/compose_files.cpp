// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/hosts/compose_files.hpp"

#include <array>

#include <fmt/format.h>

namespace rds::hosts {
namespace {

/// Names in compose.yaml.
constexpr std::array kContainers{"tracker", "detector", "transformer", "mapper", "loop-closer"};

}  // namespace

std::string compose_override(const HostsFile& hosts, const std::string& machine, const std::string& source) {
  const std::set<std::string>& here = hosts.machine(machine).services;
  std::string text = fmt::format(
      "# {0} of {1}, made by rds hosts compose:\n"
      "#   docker compose -f compose/compose.yaml -f {0}.yaml up -d\n"
      "x-here: &here\n"
      "  environment: {{ROS_DOMAIN_ID: \"{2}\", RDS_PEERS: \"{3}\"}}\n"
      "\n"
      "services:\n",
      machine, source, hosts.domain, hosts.peers_of(machine));
  for (const std::string container : kContainers)
    text += fmt::format("  {}: {}\n", container,
                        here.contains("rds-" + container) ? "*here" : "{profiles: [elsewhere]}");
  return text + fmt::format("  player: {}\n", here.contains("rds-tracker") ? "*here" : "{profiles: [elsewhere]}");
}

}  // namespace rds::hosts
