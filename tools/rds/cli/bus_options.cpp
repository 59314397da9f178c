// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/cli/bus_options.hpp"

#include <CLI/CLI.hpp>

#include "common/bus/names/topic_names.hpp"
#include "common/bus/peer_addresses.hpp"

namespace rds {

namespace {

/// A name that is not known is bad usage.
std::vector<std::string> addresses_of(const std::string& names) {
  try {
    return bus::peer_addresses(names);
  } catch (const bus::BusError& e) {
    throw CLI::ValidationError("--peers", e.what());
  }
}

}  // namespace

void add_namespace_option(CLI::App& command, std::string& node_namespace) {
  command
      .add_option_function<std::string>(
          "--namespace",
          [&node_namespace](const std::string& name) {
            try {
              node_namespace = bus::normal_namespace(name);
            } catch (const std::invalid_argument& e) {
              throw CLI::ValidationError("--namespace", e.what());
            }
          },
          "Of the robot, where several share the domain")
      ->envname("ROS_NAMESPACE");
}

void add_bus_options(CLI::App& command, BusOptions& options) {
  command.add_option("--bus", options.vendor, "fastdds or cyclonedds")
      ->check(CLI::IsMember({"fastdds", "cyclonedds"}))
      ->capture_default_str();
  command.add_option("--domain", options.domain, "DDS domain (default: ROS_DOMAIN_ID or 0)")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232));
  command.add_flag("--loopback", options.loopback_only, "this machine only");
  command
      .add_option_function<std::string>(
          "--peers", [&options](const std::string& names) { options.peers = addresses_of(names); },
          "Other machines, names or addresses: robot,nas.local,10.0.0.7")
      ->envname("RDS_PEERS");
  add_namespace_option(command, options.node_namespace);
  add_secure_options(command, options.secure);
}

}  // namespace rds
