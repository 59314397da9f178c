// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "common/bus/participant.hpp"
#include "common/topics/topics.hpp"
#include "rds_msgs/msg/Command.h"
#include "rds_msgs/msg/CommandResult.h"

namespace rds::commander {

struct CommandReply {
  bool success = false;
  std::string message;
};

/// Sends commands to services and collects their answers.
class Commander {
 public:
  /// To services; or to other processes, on topics of theirs.
  explicit Commander(bus::Participant& bus,
                     const topics::Topic<rds_msgs::msg::Command>& commands = topics::kCommand,
                     const topics::Topic<rds_msgs::msg::CommandResult>& results = topics::kCommandResult);

  /// Sends one command and waits for its answer; nullopt if none came within `limit`.
  std::optional<CommandReply> ask(const std::string& service, const std::string& verb,
                                  const std::string& argument, const std::stop_token& stop,
                                  std::chrono::milliseconds limit);

  /// Sends one command for each argument, and waits for the answers to all. @return in the same order.
  std::vector<std::optional<CommandReply>> ask_each(const std::string& service, const std::string& verb,
                                                    const std::vector<std::string>& arguments,
                                                    const std::stop_token& stop,
                                                    std::chrono::milliseconds limit);

  /// Asks all services for their status at once. @return the answers that came within `limit`, by service
  /// name.
  std::map<std::string, std::string> ask_status(std::size_t expected, const std::stop_token& stop,
                                                std::chrono::milliseconds limit);

 private:
  std::uint64_t send(const std::string& service, const std::string& verb, const std::string& argument);

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::map<std::uint64_t, std::map<std::string, CommandReply>> replies_;  // by request, by service
  std::uint64_t next_id_;
  bus::Publisher<rds_msgs::msg::Command> commands_;
  bus::Subscription results_;  // last: its callback uses the members above
};

}  // namespace rds::commander
