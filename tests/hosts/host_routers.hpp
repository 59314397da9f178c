// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/hosts/host_network.hpp"
#include "tests/hosts/hosts_table.hpp"
#include "tests/support/process.hpp"

namespace rds::test {

inline constexpr const char* kRouterHost = "R";

/// The routers of a row, `rds router`: on R, and for Way::kRouters on A too.
class HostRouters {
 public:
  HostRouters(HostNetwork& network, Way way, const std::filesystem::path& out);

  /// The one on R is killed, as by a power cut.
  void kill() { on_r_.reset(); }
  /// Does not wait for it: the camera goes on.
  void start();
  /// Zenoh's settings (a file) for programs on a host that only dial a router; empty: they are peers.
  [[nodiscard]] std::string client_settings(const std::string& host) const;

 private:
  const HostNetwork& network_;
  std::filesystem::path client_;
  std::unique_ptr<Process> on_r_;
  std::unique_ptr<Process> on_a_;
};

}  // namespace rds::test
