// SPDX-License-Identifier: Apache-2.0
#include "common/service/commands.hpp"

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "common/messages/json.hpp"
#include "common/service/process/printable.hpp"
#include "common/service/version_watch.hpp"
#include "common/topics/endpoints.hpp"

namespace rds::service {

CommandServer::CommandServer(ServiceContext& context, const Presence& presence, ServiceSlot& service)
    : context_(context),
      presence_(presence),
      service_(service),
      results_(topics::advertise(context.bus, topics::kCommandResult, topics::kServices)),
      subscription_(topics::subscribe(context.bus, topics::kCommand, topics::kServices,
                                      [this](const auto& command) { receive(*command); })) {}

void CommandServer::receive(const rds_msgs::msg::Command& command) {
  if (!command.target().empty() && command.target() != context_.name) return;
  const std::uint64_t id = command.request_id();
  if (command.verb() == "status") return answer(id, {true, status()});
  spdlog::info("command {} {}", printable(command.verb()), printable(command.argument()));
  service_.command({command.verb(), command.argument(),
                    [this, id](const auto& outcome) { answer(id, outcome); }, id, command.target().empty()});
}

void CommandServer::answer(std::uint64_t request_id, const CommandOutcome& outcome) {
  rds_msgs::msg::CommandResult result;
  result.instance(context_.instance);
  result.request_id(request_id);
  result.service(context_.name);
  result.success(outcome.success);
  result.message(outcome.message);
  results_.write(result);
}

std::string CommandServer::status() const {
  const WorkerState worker = service_.worker_state();
  nlohmann::json json{{"service", context_.name},
                      {"version", RDS_VERSION},
                      {"instance", fmt::format("{:016x}", context_.instance)},
                      {"role", presence_.is_active() ? "active" : "stand-by"},
                      {"domain", context_.domain},
                      {"pid", getpid()},
                      {"worker_silent_s", worker.silent_s}};
  auto& endpoints = json["endpoints"] = nlohmann::json::array();
  for (const auto& e : context_.bus.statistics())
    endpoints.push_back({{"topic", e.topic},
                         {"publisher", e.publisher},
                         {"matched", e.matched},
                         {"messages", e.messages},
                         {"bytes", e.bytes},
                         {"dropped", e.dropped},
                         {"another_version", e.another_version}});
  auto& others = json["another_version"] = nlohmann::json::array();
  for (const auto& mismatch : context_.bus.mismatches())
    if (others.size() < kMismatchesTold) others.push_back(describe(mismatch));
  for (const auto& [name, value] : context_.diagnostics.figures()) json["figures"][name] = value;
  return messages::to_text(json);
}

}  // namespace rds::service
