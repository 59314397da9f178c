// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace rds::bus {

/// The machines of "robot,nas.local,10.0.0.7" as IPv4 addresses, for discovery without multicast. An endpoint
/// of Zenoh ("tcp/robot:7447") stays as it is.
/// @throws BusError naming the one that is not known.
std::vector<std::string> peer_addresses(const std::string& names);

}  // namespace rds::bus
