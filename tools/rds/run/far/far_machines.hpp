// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <stop_token>
#include <string>
#include <thread>

#include "common/commander/commander.hpp"
#include "tools/rds/hosts/hosts_file.hpp"
#include "tools/rds/run/far/file_pieces.hpp"
#include "tools/rds/run/services/fleet.hpp"
#include "tools/rds/run/services/run_options.hpp"

namespace rds::run {

/// The other machines of a run that have a service of it, as the one with the camera commands them: `rds run --hosts` on each of them
/// (FarRun) starts its services, says which are alive, stops them and hands over their files.
class FarMachines {
 public:
  /// @param here  this machine.
  FarMachines(bus::Participant& bus, const RunOptions& options, const hosts::HostsFile& hosts,
              const std::string& here);
  /// Unless they were let go, the run has failed, and they are told so.
  ~FarMachines();
  FarMachines(const FarMachines&) = delete;
  FarMachines& operator=(const FarMachines&) = delete;

  /// Starts the services there, each machine as soon as it is there.
  /// @throws std::runtime_error with one sentence if one is not there in time, or refuses.
  void begin(const std::stop_token& stop);
  /// @throws std::runtime_error if a machine is silent, or its services cannot start.
  void watch() const;
  [[nodiscard]] std::set<std::string> services() const;
  /// Whether the service runs there, as its machine said last.
  [[nodiscard]] bool alive(const std::string& service) const;

  /// Copies all files below each machine's folder/prefix to `to`/prefix.
  /// @throws std::runtime_error with one sentence.
  void fetch(const std::string& prefix, const std::filesystem::path& to, const std::stop_token& stop);
  /// Stops the services there. @return what each used.
  std::map<std::string, ServiceUsage> stop_services(const std::stop_token& stop);
  /// Lets the machines go: the run is over, and their files are removed.
  void leave(const std::stop_token& stop);

 private:
  using Clock = std::chrono::steady_clock;
  struct Machine {
    std::string terms;
    std::set<std::string> services = {};  // that it has to run
    std::set<std::string> alive = {};
    std::string failure = {};  // a sentence: why its services did not start
    Clock::time_point heard = Clock::now();
    bool has_begun = false;
  };

  std::string ask(const std::string& machine, const std::string& verb, const std::string& argument,
                  std::chrono::milliseconds limit, const std::stop_token& stop);
  std::string read(const std::string& machine, const FileEntry& file, const std::stop_token& stop);
  void listen(const std::stop_token& stop);

  commander::Commander commander_;
  mutable std::mutex mutex_;
  std::map<std::string, Machine> machines_;  // by name
  std::jthread listener_;                    // last: it uses the members above
};

}  // namespace rds::run
