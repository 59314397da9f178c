// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/bus/security.hpp"

/// How a participant is given its credentials: as properties, whose names are the vendors' own.
namespace rds::bus::detail {

using Properties = std::vector<std::pair<std::string, std::string>>;

Properties fastdds_security(const Credentials& credentials);

/// Its plug-ins are libraries of their own, which are looked for beside Cyclone DDS.
Properties cyclonedds_security(const Credentials& credentials);

}  // namespace rds::bus::detail
