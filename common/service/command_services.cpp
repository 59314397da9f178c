// SPDX-License-Identifier: Apache-2.0
#include "common/service/command_services.hpp"

#include <spdlog/spdlog.h>

#include "std_srvs/srv/SetBool_Request.h"
#include "std_srvs/srv/SetBool_Response.h"
#include "std_srvs/srv/Trigger_Request.h"
#include "std_srvs/srv/Trigger_Response.h"

namespace rds::service {
namespace {

using namespace std_srvs::srv;

template <class Response>
std::function<void(const CommandOutcome&)> as_response(bus::Answer<Response> answer) {
  return [answer = std::move(answer)](const CommandOutcome& outcome) {
    Response response;
    response.success(outcome.success);
    response.message(outcome.message);
    answer(response);
  };
}

}  // namespace

CommandServices::CommandServices(ServiceContext& context, ServiceSlot& service)
    : service_(service),
      reset_(bus::serve_later<Trigger_Request, Trigger_Response>(
          context.bus, "~/reset",
          [this](const auto& /*request*/, auto answer) { post("reset", as_response(std::move(answer))); })),
      pause_(bus::serve_later<SetBool_Request, SetBool_Response>(
          context.bus, "~/pause", [this](const auto& request, auto answer) {
            post(request->data() ? "pause" : "resume", as_response(std::move(answer)));
          })) {}

void CommandServices::post(const std::string& verb, std::function<void(const CommandOutcome&)> respond) {
  spdlog::info("command {}, as a service", verb);
  service_.command({.verb = verb, .argument = "", .answer = std::move(respond)});
}

bool offers_services(const bus::ParticipantOptions& participant) {
  return !participant.credentials;
}

}  // namespace rds::service
