// SPDX-License-Identifier: Apache-2.0
#include "common/service/commands.hpp"

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace rds::service {

CommandServer::CommandServer(ServiceContext& context, Service& service)
    : context_(context),
      service_(service),
      results_(context.bus.advertise<rds_msgs::msg::CommandResult>("rds/command_result", bus::kStream)),
      subscription_(context.bus.subscribe<rds_msgs::msg::Command>(
          "rds/command", bus::kStream, [this](const auto& command) { receive(*command); })) {}

void CommandServer::receive(const rds_msgs::msg::Command& command) {
  if (!command.target().empty() && command.target() != context_.name) return;
  const std::uint64_t id = command.request_id();
  if (command.verb() == "status") return answer(id, {true, status()});
  spdlog::info("command {} {}", command.verb(), command.argument());
  service_.post(
      {command.verb(), command.argument(), [this, id](const auto& outcome) { answer(id, outcome); }});
}

void CommandServer::answer(std::uint64_t request_id, const CommandOutcome& outcome) {
  rds_msgs::msg::CommandResult result;
  result.request_id(request_id);
  result.service(context_.name);
  result.success(outcome.success);
  result.message(outcome.message);
  results_.write(result);
}

std::string CommandServer::status() const {
  nlohmann::json json{{"service", context_.name}, {"pid", getpid()}};
  auto& endpoints = json["endpoints"] = nlohmann::json::array();
  for (const auto& e : context_.bus.statistics())
    endpoints.push_back({{"topic", e.topic},
                         {"publisher", e.publisher},
                         {"matched", e.matched},
                         {"messages", e.messages},
                         {"bytes", e.bytes},
                         {"dropped", e.dropped}});
  for (const auto& [name, value] : context_.diagnostics.figures()) json["figures"][name] = value;
  return json.dump();
}

}  // namespace rds::service
