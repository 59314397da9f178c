// SPDX-License-Identifier: Apache-2.0
#include "common/service/service.hpp"

#include "common/service/process/printable.hpp"

namespace rds::service {
namespace {
constexpr std::size_t kMaxWaitingCommands = 64;
}

std::string full_node_name(const ServiceContext& context) {
  const std::string& above = context.node_namespace;
  return (above == "/" ? "" : above) + "/" + context.participant.node_name;
}

Service::Service(ServiceContext& context) : context_(context), commands_(mailbox_, kMaxWaitingCommands) {
  beat();
}

Service::~Service() {
  while (auto command = commands_.try_pop()) command->answer({false, "the service has stopped"});
}

std::chrono::steady_clock::duration Service::silent_for() const {
  using Clock = std::chrono::steady_clock;
  return Clock::now() - Clock::time_point(Clock::duration(last_beat_));
}

CommandOutcome Service::unknown_command(const std::string& verb) {
  return {false, fmt::format("'{}' is not a command of this service", printable(verb))};
}

void Service::handle_commands() {
  while (auto command = commands_.try_pop()) {
    CommandOutcome outcome;
    try {
      if (begin(*command)) continue;
      outcome = carry_out(*command);
    } catch (const std::exception& e) {
      ++context_.diagnostics.counter("commands failed");
      outcome = {false, printable(e.what())};
    }
    command->answer(outcome);
  }
}

CommandOutcome Service::carry_out(const PendingCommand& command) {
  if (command.verb == "set" && set_) return set_(command.argument);
  const CommandOutcome outcome = execute(command.verb, command.argument);
  if (outcome.success && (command.verb == "pause" || command.verb == "resume"))
    tell_paused_(command.verb == "pause");
  return outcome;
}

}  // namespace rds::service
