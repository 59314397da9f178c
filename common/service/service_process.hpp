// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <thread>

#include "common/service/command_services.hpp"
#include "common/service/commands.hpp"
#include "common/service/diagnostics_publisher.hpp"
#include "common/service/presence.hpp"
#include "common/service/process/deafness_watch.hpp"
#include "common/service/process/hang_watch.hpp"
#include "common/service/ros/bond.hpp"
#include "common/service/ros/lifecycle_services.hpp"
#include "common/service/ros/parameter_services.hpp"
#include "common/service/service_slot.hpp"
#include "common/service/settings/settings.hpp"

namespace rds::service {

struct ProcessOptions {
  /// The process ends with status 1 when the worker, or what reports about it, was silent for longer [s]; 0:
  /// never. For supervisors that start again what has ended, but see nothing that hangs.
  double exit_when_hung_s = 0;
  /// A lifecycle manager of ROS 2 brings it up: it begins unconfigured, and holds a bond.
  bool managed = false;
  /// The settings as ROS 2 asks for them; empty: it cannot.
  std::function<ParameterTable()> parameters = {};
};

/// A service and all around it that a process needs: worker, commands, diagnostics, and its place among
/// others of its kind. While another one is active it waits as stand-by, without a worker.
class ServiceProcess {
 public:
  /// @param context, settings  must outlive it.
  ServiceProcess(ServiceContext& context, Settings& settings, ProcessOptions options = {});

  /// Runs until SIGINT or SIGTERM (both must be blocked in all threads) or until the worker fails. A second
  /// signal ends the process at once. @return 0 after a clean stop, 1 after a fault.
  /// @throws what making the service throws at the start.
  int run();
  /// As a signal does (any thread).
  void request_stop() { events_.push(Event::kSignal); }

 private:
  enum class Event { kSignal, kWorkerEnded, kPeersChanged };

  void watch(const std::stop_token& stop);
  void end_if_hung(double since_last_look_s);
  void end_if_deaf(double since_last_look_s);
  void activate();
  void offer_services(Service& service);
  void offer_parameters();
  void stand_by();
  void change_role();
  void work(const std::stop_token& stop, Service& service);

  ServiceContext& context_;
  Settings& settings_;
  ProcessOptions options_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Event> events_;
  ServiceSlot service_;
  bool failed_ = false;
  Presence presence_;
  std::optional<CommandServer> commands_;                // once there is a worker that can execute them
  std::optional<CommandServices> command_services_;      // while it is the active one; …
  std::optional<LifecycleServices> lifecycle_services_;  // … likewise
  std::optional<ParameterServices> parameter_services_;  // … likewise
  std::optional<Bond> bond_;                             // … if it is managed
  DiagnosticsPublisher publisher_;
  HangWatch hang_watch_;
  DeafnessWatch deafness_watch_;
  std::jthread worker_;
};

}  // namespace rds::service
