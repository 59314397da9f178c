// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/hosts/wire/impaired_direction.hpp"
#include "tests/support/process.hpp"

namespace rds::test {

/// The link of a host to the switch, in both directions.
struct Link {
  int rate_mbit = 1000;
  Impairment impairment = {};  // of none there is no process on the way

  [[nodiscard]] bool is_impaired() const {
    return impairment.delay_ms > 0 || impairment.jitter_ms > 0 || impairment.loss > 0;
  }
};

/// Hosts on a switch: network namespaces on one machine. Each is held by a process that dies with this one
/// and has no name, so nothing is left behind, whatever happens, and two of these never meet.
class HostNetwork {
 public:
  /// Why there can be none here, in one line; empty if there can.
  static std::string why_not();

  /// @param hosts  names. @param link  of the first one; the others' has no limit.
  /// @param multicast  whether the switch passes it on.
  /// @throws std::runtime_error with what `ip`, `bridge` or `tc` said.
  HostNetwork(const std::vector<std::string>& hosts, const Link& link, bool multicast = true);

  /// The command, to be run on a host.
  [[nodiscard]] std::vector<std::string> on(const std::string& host,
                                            const std::vector<std::string>& command) const;
  /// A host's link is pulled out at the switch, which nobody is told; and plugged in again.
  void unplug(const std::string& host);
  void plug(const std::string& host);
  /// From now on a host can dial the others, but nobody can dial it, as behind NAT.
  void hide(const std::string& host);
  [[nodiscard]] std::string address(const std::string& host) const;

 private:
  friend class OnHost;
  [[nodiscard]] std::string namespace_file(const std::string& host) const;
  void run(const std::string& host, const std::string& script) const;
  void add_host(const std::string& host);
  void limit_rate(const std::string& host, int rate_mbit) const;
  void add_wire(const std::string& host, const Impairment& impairment);

  bool multicast_;

  std::map<std::string, std::unique_ptr<Process>> holders_;  // by host, and the switch
  std::map<std::string, std::string> addresses_;
  std::map<std::string, std::string> ports_;  // interfaces of the switch
  std::unique_ptr<Process> wire_;
};

/// While it lives the calling thread, and all that it starts, is on a host.
class OnHost {
 public:
  OnHost(const HostNetwork& network, const std::string& host);
  ~OnHost();
  OnHost(const OnHost&) = delete;
  OnHost& operator=(const OnHost&) = delete;

 private:
  int before_ = -1;
};

/// Runs this in a process of its own, which leaves its results in files: Zenoh's threads stay in the network
/// in which the first of them began. Before, this process must have had no other thread.
/// @throws std::runtime_error if `work` throws, after printing what.
void in_own_process(const std::function<void()>& work);

/// Bytes that the calling thread's host has sent to its link since it was made.
std::uint64_t bytes_sent();
/// … and that have come.
std::uint64_t bytes_received();

}  // namespace rds::test
