// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/services/join_bus.hpp"

#include "common/bus/peer_addresses.hpp"
#include "tools/rds/topology/topology.hpp"

namespace rds::run {

bus::ParticipantOptions run_participant(const RunOptions& options, int domain, const std::string& node_name) {
  return {.vendor = options.vendor_of(kPlayer),
          .domain = domain,
          .node_name = node_name,
          .loopback_only = !options.network,
          .peers = bus::peer_addresses(options.here ? options.here->peers : ""),
          .credentials = options.secure.credentials(),
          .node_namespace = options.node_namespace};
}

std::unique_ptr<bus::Participant> join_bus(const RunOptions& options, int domain) {
  return bus::Participant::create(run_participant(options, domain, "rds_run"));
}

}  // namespace rds::run
