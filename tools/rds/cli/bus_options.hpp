// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "common/bus/participant.hpp"
#include "tools/rds/cli/secure_options.hpp"

namespace rds {

/// How a tool joins the bus.
struct BusOptions {
  std::string vendor = "fastdds";
  int domain = 0;
  bool loopback_only = false;
  std::vector<std::string> peers;  // addresses
  std::string node_namespace;      // of the robot
  SecureOptions secure;

  /// @throws std::runtime_error with one sentence if there is something wrong with the credentials.
  [[nodiscard]] bus::ParticipantOptions participant(const std::string& node_name) const {
    return {.vendor = bus::vendor_from_name(vendor),
            .domain = domain,
            .node_name = node_name,
            .loopback_only = loopback_only,
            .peers = peers,
            .credentials = secure.credentials(),
            .node_namespace = node_namespace};
  }
};

/// Adds --bus, --domain (default: ROS_DOMAIN_ID or 0), --loopback, --peers, --namespace (default:
/// ROS_NAMESPACE), --secure and --identity.
void add_bus_options(CLI::App& command, BusOptions& options);

/// Adds --namespace alone.
void add_namespace_option(CLI::App& command, std::string& node_namespace);

}  // namespace rds
