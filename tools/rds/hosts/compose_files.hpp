// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/rds/hosts/hosts_file.hpp"

namespace rds::hosts {

/// An override of compose/compose.yaml for one machine: the services that are elsewhere do not start, the
/// others know the domain and the other machines.
/// @param source  the hosts file's name, for the comment. @return YAML.
std::string compose_override(const HostsFile& hosts, const std::string& machine, const std::string& source);

}  // namespace rds::hosts
