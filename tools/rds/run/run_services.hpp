// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stop_token>
#include <string>

#include "tools/rds/run/far/far_machines.hpp"
#include "tools/rds/run/services/fleet.hpp"
#include "tools/rds/run/services/run_options.hpp"

namespace rds::run {

/// The other machines of a run.
struct Elsewhere {
  hosts::HostsFile hosts;
  std::string here;  // the name of this one
};

/// The services of a run, those on other machines included.
class RunServices {
 public:
  /// Starts those that run here. @param folder  of the run.
  /// @throws std::runtime_error, config::ConfigError with one sentence.
  RunServices(const RunOptions& options, int domain, const std::filesystem::path& folder,
              bus::Participant& bus, const std::optional<Elsewhere>& elsewhere);

  /// Starts the others. @throws std::runtime_error with one sentence, as FarMachines::begin().
  void begin_elsewhere(const std::stop_token& stop);
  /// Restarts those here that died. @throws Fleet::StartupFailure, std::runtime_error as
  /// FarMachines::watch().
  void watch();

  [[nodiscard]] std::set<std::string> names() const;
  /// Those on other machines.
  [[nodiscard]] std::set<std::string> elsewhere() const;
  [[nodiscard]] bool alive(const std::string& name);

  /// Brings what services on other machines have below `folder` of the run here.
  void fetch(const std::string& folder, const std::stop_token& stop);
  /// Stops all but a viewer that is kept, and brings the others' logs and settings here. @return what each
  /// used.
  std::map<std::string, ServiceUsage> stop(const std::stop_token& stop);
  /// Keeps the viewer's page until stop is requested, or the viewer is given up.
  void keep_viewer(const std::stop_token& stop);

 private:
  std::filesystem::path folder_;
  std::unique_ptr<FarMachines> far_;  // nullptr: all are here
  Fleet fleet_;
  std::unique_ptr<Fleet> viewer_;  // nullptr: none; it is no part of the results
  bool keeps_viewer_;
};

}  // namespace rds::run
