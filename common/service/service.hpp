// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <type_traits>
#include <utility>

#include "common/bus/participant.hpp"
#include "common/concurrency/mailbox.hpp"
#include "common/config/config_reader.hpp"
#include "common/service/diagnostics.hpp"
#include "common/service/peers/instance_owners.hpp"
#include "common/service/random_id.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::service {

/// What a service is given by its process.
struct ServiceContext {
  std::string name;
  bus::Participant& bus;
  Diagnostics& diagnostics;
  int domain = 0;
  std::uint64_t instance = random_id();      // of this process, in all that it publishes
  bus::ParticipantOptions participant = {};  // how it joined the bus
  std::string node_namespace = "/";          // of the robot
  std::string frame_prefix = {};             // of the robot's frames

  /// The robot's frame of this name: "robot1/map".
  [[nodiscard]] std::string frame(const std::string& id) const { return frame_prefix + id; }
};

/// Of its node: "/robot1/rds_tracker".
std::string full_node_name(const ServiceContext& context);

struct CommandOutcome {
  bool success = false;
  std::string message;  // what was done, or why not
};

/// A command on its way to the worker, and how to answer it: once, from any thread.
struct PendingCommand {
  std::string verb;
  std::string argument;
  std::function<void(const CommandOutcome&)> answer;
  std::uint64_t request_id = 0;
  bool to_all = false;  // not to this service alone
};

/// One worker thread that owns a core; bus callbacks only fill its inboxes.
class Service {
 public:
  explicit Service(ServiceContext& context);
  /// Commands that still wait are answered: the service has stopped.
  virtual ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// The worker's loop: returns when stop is requested. An exception ends the process with status 1.
  virtual void run(const std::stop_token& stop) = 0;
  /// What a clean stop has still to do, on the worker, after run() has returned.
  virtual void close() {}

  /// Queues a command for the worker (any thread). @return false if too many wait: the service is busy.
  bool post(PendingCommand command) { return commands_.try_push(std::move(command)); }

  /// @param tell  is told, on the worker, whenever a command has paused or resumed it. Before run().
  void when_paused(std::function<void(bool paused)> tell) { tell_paused_ = std::move(tell); }

  /// @param set  carries the command `set` out, on the worker (Settings). Before run().
  void when_set(std::function<CommandOutcome(const std::string& changes)> set) { set_ = std::move(set); }

  /// Since the worker last said that it is alive (any thread).
  [[nodiscard]] std::chrono::steady_clock::duration silent_for() const;

 protected:
  /// Begins a command that is answered later, on the worker. @return false for all others: they are for
  /// execute().
  virtual bool begin(const PendingCommand& command) {
    (void)command;
    return false;
  }
  /// Carries a command out, on the worker. Unknown verbs: unknown_command().
  virtual CommandOutcome execute(const std::string& verb, const std::string& argument) = 0;
  [[nodiscard]] static CommandOutcome unknown_command(const std::string& verb);

  /// Begins or answers all waiting commands, on the worker; an exception becomes the answer.
  void handle_commands();

  /// The worker is alive. Called by wait(), and where one step of the worker may take seconds.
  void beat() { last_beat_ = std::chrono::steady_clock::now().time_since_epoch().count(); }

  /// Mailbox::wait() of a worker that says in between that it is alive.
  template <class Ready>
  bool wait(const std::stop_token& stop, Ready ready) {
    for (beat(); !stop.stop_requested(); beat()) {
      if (mailbox_.wait_for(stop, kBeatInterval, ready)) return true;
      idle();
    }
    return false;
  }

  /// Called by wait() twice a second while nothing arrives.
  virtual void idle() {}

  /// One step of the worker with one message: an exception is counted as a failure of that topic, and the
  /// worker goes on. @return whether there was none.
  template <class Step>
  bool guarded(const std::string& topic, Step step) {
    try {
      step();
      return true;
    } catch (const std::exception& e) {
      context_.diagnostics.reject(topic, Rejection::kFailed, e.what());
      return false;
    }
  }

  /// Subscribes to messages that name the instance of the service which wrote them. What another participant
  /// writes in its name is refused and counted, and never reaches the callback.
  template <class Message>
  bus::Subscription subscribe_to_instances(
      const topics::Topic<Message>& topic, topics::Process process,
      std::type_identity_t<std::function<void(std::shared_ptr<const Message>)>> callback) {
    return topics::subscribe(
        context_.bus, topic, process, owners_.only_owned(std::move(callback), [this, name = topic.name] {
          context_.diagnostics.reject(name, Rejection::kForged, "written in another one's name");
        }));
  }

  ServiceContext& context_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<PendingCommand> commands_;

 private:
  static constexpr std::chrono::milliseconds kBeatInterval{500};

  CommandOutcome carry_out(const PendingCommand& command);

  InstanceOwners owners_;
  std::function<void(bool)> tell_paused_ = [](bool) {};
  std::function<CommandOutcome(const std::string&)> set_;
  std::atomic<std::chrono::steady_clock::rep> last_beat_;
};

}  // namespace rds::service
