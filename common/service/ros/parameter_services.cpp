// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/parameter_services.hpp"

#include <chrono>
#include <memory>
#include <stdexcept>
#include <utility>

#include "common/messages/conversions.hpp"
#include "rcl_interfaces/srv/DescribeParameters_Request.h"
#include "rcl_interfaces/srv/DescribeParameters_Response.h"
#include "rcl_interfaces/srv/GetParameterTypes_Request.h"
#include "rcl_interfaces/srv/GetParameterTypes_Response.h"
#include "rcl_interfaces/srv/GetParameters_Request.h"
#include "rcl_interfaces/srv/GetParameters_Response.h"
#include "rcl_interfaces/srv/ListParameters_Request.h"
#include "rcl_interfaces/srv/ListParameters_Response.h"
#include "rcl_interfaces/srv/SetParametersAtomically_Request.h"
#include "rcl_interfaces/srv/SetParametersAtomically_Response.h"
#include "rcl_interfaces/srv/SetParameters_Request.h"
#include "rcl_interfaces/srv/SetParameters_Response.h"

namespace rds::service {
namespace {

using namespace rcl_interfaces::srv;
using rcl_interfaces::msg::Parameter;
using rcl_interfaces::msg::ParameterEvent;
using rcl_interfaces::msg::SetParametersResult;

/// An answer may be fifty times as large as the question: a few times what any node has.
constexpr std::size_t kMostNames = 1000;

constexpr bus::Qos kEvents{.reliable = true, .depth = 1000};  // as rclcpp's

template <class Sequence>
const Sequence& checked(const Sequence& asked) {
  if (asked.size() > kMostNames) throw std::invalid_argument("too many names");
  return asked;
}

SetParametersResult result(bool success, const std::string& reason = "") {
  SetParametersResult told;
  told.successful(success);
  if (!success) told.reason(reason);
  return told;
}

/// Several results, each told once, on any thread; the last one lets all be answered.
class Results {
 public:
  using Answer = bus::Answer<SetParameters_Response>;
  Results(std::size_t number, Answer answer) : open_(number), answer_(std::move(answer)) {
    response_.results().resize(number);
    if (number == 0) answer_(response_);
  }
  void tell(std::size_t which, SetParametersResult result) {
    const std::lock_guard lock(mutex_);
    response_.results()[which] = std::move(result);
    if (--open_ == 0) answer_(response_);
  }

 private:
  std::mutex mutex_;
  std::size_t open_;
  SetParameters_Response response_;
  Answer answer_;
};

}  // namespace

ParameterServices::ParameterServices(bus::Participant& bus, ParameterTable table, std::string node, Set set)
    : table_(std::move(table)),
      node_(std::move(node)),
      set_(std::move(set)),
      events_(bus.advertise<ParameterEvent>("/parameter_events", kEvents)) {  // of every node, so in no table
  serve_questions(bus);
  serve_changes(bus);
}

void ParameterServices::serve_questions(bus::Participant& bus) {
  services_.push_back(bus::serve<ListParameters_Request, ListParameters_Response>(
      bus, "~/list_parameters", [this](const ListParameters_Request& request) {
        ListParameters_Response response;
        response.result(locked([&](const ParameterTable& table) {
          return table.list(checked(request.prefixes()), request.depth());
        }));
        return response;
      }));
  services_.push_back(bus::serve<GetParameters_Request, GetParameters_Response>(
      bus, "~/get_parameters", [this](const GetParameters_Request& request) {
        GetParameters_Response response;
        response.values(locked([&](const auto& table) { return table.values(checked(request.names())); }));
        return response;
      }));
  services_.push_back(bus::serve<GetParameterTypes_Request, GetParameterTypes_Response>(
      bus, "~/get_parameter_types", [this](const GetParameterTypes_Request& request) {
        GetParameterTypes_Response response;
        response.types(locked([&](const auto& table) { return table.kinds(checked(request.names())); }));
        return response;
      }));
  services_.push_back(bus::serve<DescribeParameters_Request, DescribeParameters_Response>(
      bus, "~/describe_parameters", [this](const DescribeParameters_Request& request) {
        DescribeParameters_Response response;
        response.descriptors(
            locked([&](const auto& table) { return table.descriptors(checked(request.names())); }));
        return response;
      }));
}

void ParameterServices::serve_changes(bus::Participant& bus) {
  services_.push_back(bus::serve_later<SetParameters_Request, SetParameters_Response>(
      bus, "~/set_parameters", [this](const auto& request, auto answer) {
        const auto& parameters = checked(request->parameters());
        const auto results = std::make_shared<Results>(parameters.size(), std::move(answer));
        for (std::size_t i = 0; i < parameters.size(); ++i)
          set(Parameters{parameters[i]}, [results, i](auto told) { results->tell(i, std::move(told)); });
      }));
  services_.push_back(bus::serve_later<SetParametersAtomically_Request, SetParametersAtomically_Response>(
      bus, "~/set_parameters_atomically", [this](const auto& request, auto answer) {
        set(checked(request->parameters()), [answer = std::move(answer)](auto told) {
          SetParametersAtomically_Response response;
          response.result(std::move(told));
          answer(response);
        });
      }));
}

/// All of them, or none.
void ParameterServices::set(const Parameters& parameters,
                            const std::function<void(SetParametersResult)>& tell) {
  if (parameters.empty()) return tell(result(true));
  const auto changes = locked([&](const ParameterTable& table) { return table.changes(parameters); });
  if (!changes) return tell(result(false, changes.error()));
  set_(*changes, [tell](bool success, const std::string& reason) { tell(result(success, reason)); });
}

void ParameterServices::take(const std::map<std::string, YAML::Node>& changes) {
  ParameterEvent event;
  event.stamp(messages::to_time(
      std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count()));
  event.node(node_);
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, value] : changes) {
      Parameter& changed = event.changed_parameters().emplace_back();
      changed.name(name);
      changed.value(table_.set(name, value));
    }
  }
  events_.write(event);
}

}  // namespace rds::service
