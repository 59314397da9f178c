// SPDX-License-Identifier: Apache-2.0
#include "common/service/service.hpp"

namespace rds::service {
namespace {
constexpr std::size_t kMaxWaitingCommands = 64;
}

Service::Service(ServiceContext& context) : context_(context), commands_(mailbox_, kMaxWaitingCommands) {}

CommandOutcome Service::unknown_command(const std::string& verb) {
  return {false, fmt::format("'{}' is not a command of this service", verb)};
}

void Service::handle_commands() {
  while (auto command = commands_.try_pop()) command->answer(execute(command->verb, command->argument));
}

}  // namespace rds::service
