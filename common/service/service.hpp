// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "common/bus/participant.hpp"
#include "common/concurrency/mailbox.hpp"
#include "common/config/config_reader.hpp"
#include "common/service/diagnostics.hpp"

namespace rds::service {

/// What a service is given by its process.
struct ServiceContext {
  std::string name;
  bus::Participant& bus;
  Diagnostics& diagnostics;
};

struct CommandOutcome {
  bool success = false;
  std::string message;  // what was done, or why not
};

/// A command on its way to the worker, and how to answer it.
struct PendingCommand {
  std::string verb;
  std::string argument;
  std::function<void(const CommandOutcome&)> answer;
};

/// One worker thread that owns a core; bus callbacks only fill its inboxes.
class Service {
 public:
  explicit Service(ServiceContext& context);
  virtual ~Service() = default;
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// The worker's loop: returns when stop is requested. An exception ends the process with status 1.
  virtual void run(const std::stop_token& stop) = 0;

  /// Queues a command for the worker (any thread).
  void post(PendingCommand command) { commands_.push(std::move(command)); }

 protected:
  /// Carries a command out, on the worker. Unknown verbs: unknown_command().
  virtual CommandOutcome execute(const std::string& verb, const std::string& argument) = 0;
  [[nodiscard]] static CommandOutcome unknown_command(const std::string& verb);

  /// Answers all waiting commands, on the worker.
  void handle_commands();

  ServiceContext& context_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<PendingCommand> commands_;
};

/// Reads its configuration from the reader, then builds the service.
using ServiceFactory = std::function<std::unique_ptr<Service>(ServiceContext&, config::ConfigReader&)>;

/// The whole main() of a service: command line, configuration, log, signals, commands, diagnostics, worker.
/// @return 0 after a clean stop, 1 after a fault, 2 for bad usage or configuration.
int run_service(const std::string& name, int argc, char** argv, const ServiceFactory& factory);

/// Lowers the priority of the process; says so where that is not allowed.
void give_way(int nice);

/// run_service() for a service whose configuration is read by `read(ConfigReader&, Config&)`; the process
/// gives way to others by its `nice`.
template <class ServiceType, class Config>
int run_service(const std::string& name, int argc, char** argv) {
  return run_service(name, argc, argv, [](ServiceContext& context, config::ConfigReader& reader) {
    Config config;
    read(reader, config);
    reader.finish();
    give_way(config.nice);
    return std::make_unique<ServiceType>(context, config);
  });
}

}  // namespace rds::service
