// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tools/rds/run/services/child_process.hpp"

namespace rds::run {

/// How one service is started.
struct ServiceCommand {
  std::string name;                  // rds-tracker
  std::vector<std::string> command;  // executable and arguments
  std::filesystem::path log;
};

/// What a service used over all its lives.
struct ServiceUsage {
  double cpu_s = 0;
  std::uint64_t peak_bytes = 0;
  int restarts = 0;
  std::vector<int> failures;  // exit statuses that were not asked for
};

/// The services of one run: watched, restarted when they die, stopped together.
class Fleet {
 public:
  /// @throws std::runtime_error if one cannot be started.
  explicit Fleet(std::vector<ServiceCommand> services);
  /// One more, likewise.
  void start(ServiceCommand service);

  /// Restarts services that died, at most `kMaxRestarts` times each.
  /// @throws StartupFailure if one exited with status 2: its configuration or usage is wrong.
  void watch();

  /// Stops all within `limit`.
  void stop(std::chrono::milliseconds limit);

  [[nodiscard]] std::set<std::string> names() const;
  [[nodiscard]] bool healthy() const;
  [[nodiscard]] bool alive(const std::string& name);
  [[nodiscard]] const std::map<std::string, ServiceUsage>& usage() const { return usage_; }

  /// A service refused to start; what() is what it said.
  class StartupFailure : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
  };

 private:
  static constexpr int kMaxRestarts = 5;
  struct Member {
    ServiceCommand service;
    ChildProcess process;
    bool given_up = false;
  };
  void account(const std::string& name, const ChildExit& exit);

  std::vector<Member> members_;
  std::map<std::string, ServiceUsage> usage_;
};

}  // namespace rds::run
