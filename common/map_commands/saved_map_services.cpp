// SPDX-License-Identifier: Apache-2.0
#include "common/map_commands/saved_map_services.hpp"

#include <chrono>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "common/map_commands/live_map_save.hpp"
#include "common/map_file/named_map.hpp"
#include "common/service/command_services.hpp"
#include "common/service/process/printable.hpp"
#include "rds_msgs/srv/LoadMap_Request.h"
#include "rds_msgs/srv/LoadMap_Response.h"
#include "rds_msgs/srv/SaveMap_Request.h"
#include "rds_msgs/srv/SaveMap_Response.h"

namespace rds::map_commands {
namespace {

using namespace rds_msgs::srv;
using service::CommandOutcome;

constexpr std::chrono::seconds kSearch{3};  // for a loop closer, which need not be there

CommandOutcome save(bus::Participant& bus, const std::string& name, const std::stop_token& stop) {
  const auto saved = save_live_map(bus, name, kSearch, stop);
  if (!saved) return {false, saved.error()};
  return {true, fmt::format("saved as {} in {}", name, saved->folder.string())};
}

CommandOutcome load(bus::Participant& bus, const std::string& name, const std::stop_token& stop) {
  const auto answers = load_live_map(bus, name, kSearch, stop);
  if (!answers) return {false, answers.error()};
  std::string told;
  for (const auto& [service, answer] : *answers)
    told += fmt::format("{}{}: {}", told.empty() ? "" : "; ", service, answer);
  return {true, told};
}

}  // namespace

SavedMapServices::SavedMapServices(service::ServiceContext& context)
    : jobs_(mailbox_, 1), thread_([this](const std::stop_token& stop) {
        while (mailbox_.wait(stop, [this] { return !jobs_.locked_empty(); }))
          if (const auto job = jobs_.try_pop()) (*job)(stop);
      }) {
  if (!service::offers_services(context.participant)) return;
  services_.push_back(serve<SaveMap_Request, SaveMap_Response>(context.bus, "~/save_map", save));
  services_.push_back(serve<LoadMap_Request, LoadMap_Response>(context.bus, "~/load_map", load));
}

template <class Request, class Response>
bus::ServiceServer SavedMapServices::serve(bus::Participant& bus, const std::string& offered, Ask* ask) {
  return bus::serve_later<Request, Response>(
      bus, offered, [this, &bus, offered, ask](const auto& request, auto answer) {
        const auto respond = [answer = std::move(answer)](const CommandOutcome& outcome) {
          Response response;
          response.success(outcome.success);
          response.message(outcome.message);
          answer(response);
        };
        const std::string name = request->name();
        spdlog::info("{} {}, as a service", offered, service::printable(name));
        if (const auto checked = map_file::check_map_name(name); !checked)
          return respond({false, checked.error()});
        const bool is_taken = jobs_.try_push([&bus, ask, name, respond](const std::stop_token& stop) {
          try {
            respond(ask(bus, name, stop));
          } catch (const std::exception& e) {
            respond({false, service::printable(e.what())});
          }
        });
        if (!is_taken) respond({false, "busy: another map is being saved or loaded"});
      });
}

}  // namespace rds::map_commands
