// SPDX-License-Identifier: Apache-2.0
#include "common/service/ros/lifecycle_services.hpp"

#include <chrono>

#include <spdlog/spdlog.h>

#include "lifecycle_msgs/msg/TransitionEvent.h"
#include "lifecycle_msgs/srv/ChangeState_Request.h"
#include "lifecycle_msgs/srv/ChangeState_Response.h"
#include "lifecycle_msgs/srv/GetAvailableStates_Request.h"
#include "lifecycle_msgs/srv/GetAvailableStates_Response.h"
#include "lifecycle_msgs/srv/GetAvailableTransitions_Request.h"
#include "lifecycle_msgs/srv/GetAvailableTransitions_Response.h"
#include "lifecycle_msgs/srv/GetState_Request.h"
#include "lifecycle_msgs/srv/GetState_Response.h"

namespace rds::service {
namespace {

using namespace lifecycle_msgs::srv;
using lifecycle_msgs::msg::State;
using lifecycle_msgs::msg::Transition;
using lifecycle_msgs::msg::TransitionDescription;
using lifecycle_msgs::msg::TransitionEvent;

State to_message(const LifecycleState& state) {
  State message;
  message.id(state.id);
  message.label(state.label);
  return message;
}

Transition to_message(std::uint8_t id, const std::string& label) {
  Transition message;
  message.id(id);
  message.label(label);
  return message;
}

GetAvailableTransitions_Response to_message(std::span<const LifecycleTransition> transitions) {
  GetAvailableTransitions_Response response;
  for (const LifecycleTransition& t : transitions) {
    TransitionDescription& description = response.available_transitions().emplace_back();
    description.transition(to_message(t.id, t.label));
    description.start_state(to_message(t.start));
    description.goal_state(to_message(t.during));  // as rclcpp has it
  }
  return response;
}

/// Publishes what happens.
std::function<void(const LifecycleEvent&)> publish_events(bus::Participant& bus) {
  const auto publisher = std::make_shared<bus::Publisher<TransitionEvent>>(
      bus.advertise<TransitionEvent>("~/transition_event", bus::kStream));  // of the node, so in no table
  return [publisher](const LifecycleEvent& event) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    TransitionEvent message;
    message.timestamp(
        static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count()));
    message.transition(to_message(event.id, event.label));
    message.start_state(to_message(event.start));
    message.goal_state(to_message(event.goal));
    publisher->write(message);
  };
}

bus::ServiceServer serve_transitions(bus::Participant& bus, const std::string& name,
                                     std::function<GetAvailableTransitions_Response()> answer) {
  return bus::serve<GetAvailableTransitions_Request, GetAvailableTransitions_Response>(
      bus, name, [answer = std::move(answer)](const auto& /*request*/) { return answer(); });
}

}  // namespace

LifecycleServices::LifecycleServices(bus::Participant& bus, Post post, std::function<void()> stop,
                                     const LifecycleState& begin)
    : lifecycle_(std::make_shared<Lifecycle>(publish_events(bus), begin)),
      post_(std::move(post)),
      stop_(std::move(stop)),
      change_(serve_changes(bus)),
      state_(bus::serve<GetState_Request, GetState_Response>(bus, "~/get_state",
                                                             [this](const auto& /*request*/) {
                                                               GetState_Response response;
                                                               response.current_state(
                                                                   to_message(lifecycle_->state()));
                                                               return response;
                                                             })),
      states_(bus::serve<GetAvailableStates_Request, GetAvailableStates_Response>(
          bus, "~/get_available_states",
          [](const auto& /*request*/) {
            GetAvailableStates_Response response;
            for (const LifecycleState& state : lifecycle_states())
              response.available_states().push_back(to_message(state));
            return response;
          })),
      transitions_(serve_transitions(bus, "~/get_available_transitions",
                                     [this] { return to_message(lifecycle_->available()); })),
      graph_(serve_transitions(bus, "~/get_transition_graph",
                               [] { return to_message(lifecycle_transitions()); })) {}

std::function<void(bool)> LifecycleServices::when_paused() const {
  return [lifecycle = lifecycle_](bool paused) { lifecycle->set_paused(paused); };
}

bus::ServiceServer LifecycleServices::serve_changes(bus::Participant& bus) {
  return bus::serve_later<ChangeState_Request, ChangeState_Response>(
      bus, "~/change_state", [this](const auto& request, auto answer) {
        const auto respond = [answer](bool succeeded) {
          ChangeState_Response response;
          response.success(succeeded);
          answer(response);
        };
        const auto begun = lifecycle_->begin(request->transition().id(), request->transition().label());
        if (!begun) return respond(false);
        spdlog::info("transition {}, as a service", begun->label);
        const auto end = [lifecycle = lifecycle_, respond](bool succeeded) {
          lifecycle->end(succeeded);
          respond(succeeded);
        };
        const std::string verb = begun->verb;
        if (verb == kStopVerb) {
          end(true);
          return stop_();
        }
        if (verb.empty()) return end(true);
        if (!post_(verb, end)) end(false);
      });
}

}  // namespace rds::service
