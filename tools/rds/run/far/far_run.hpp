// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "common/bus/participant.hpp"
#include "common/concurrency/mailbox.hpp"
#include "rds_msgs/msg/Command.h"
#include "rds_msgs/msg/CommandResult.h"
#include "tools/rds/hosts/hosts_file.hpp"
#include "tools/rds/run/services/fleet.hpp"
#include "tools/rds/run/services/run_options.hpp"

namespace rds::run {

/// One run's part on a machine without the camera: waits for the machine with the camera (FarMachines there),
/// starts the services as that one says, and hands over what they leave.
class FarRun {
 public:
  /// @param options  of this machine's own command line, with its place and the domain. @throws std::runtime_error, bus::BusError
  FarRun(RunOptions options, const hosts::HostsFile& hosts, const std::string& machine);
  ~FarRun();
  FarRun(const FarRun&) = delete;
  FarRun& operator=(const FarRun&) = delete;

  /// @return the process's exit status: 0 if the run is over and every service stayed healthy, 1 otherwise.
  int run(const std::stop_token& stop);

 private:
  using Clock = std::chrono::steady_clock;
  using Request = std::shared_ptr<const rds_msgs::msg::Command>;

  void answer(const rds_msgs::msg::Command& request);
  std::string carry_out(const rds_msgs::msg::Command& request);
  std::string begin(const std::string& terms);
  std::string alive();
  std::string stop_services();
  std::string leave(const std::string& outcome);
  void watch();

  enum class State : std::uint8_t { kWaiting, kRunning, kStopped, kOver };

  RunOptions options_;
  hosts::Machine machine_;
  std::filesystem::path folder_;  // of this run, removed at its end
  State state_ = State::kWaiting;
  std::string terms_;  // that were accepted
  std::unique_ptr<Fleet> fleet_;
  std::optional<std::string> failure_;  // a sentence
  Clock::time_point heard_ = Clock::now();
  std::unique_ptr<bus::Participant> bus_;
  bus::Publisher<rds_msgs::msg::CommandResult> replies_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Request> requests_;
  bus::Subscription subscription_;  // last: its callback uses the members above
};

}  // namespace rds::run
