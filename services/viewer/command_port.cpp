// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/command_port.hpp"

#include <algorithm>
#include <set>

#include "common/topics/endpoints.hpp"
#include "services/viewer/scene_frames.hpp"

namespace rds::viewer {
namespace {

/// Who carries a verb out; others that hear it answer that they do not know it.
const std::set<std::string>& services_for(const std::string& verb) {
  static const std::set<std::string> kWithMap{"rds-tracker", "rds-mapper", "rds-loop-closer"};
  static const std::set<std::string> kTracker{"rds-tracker"};
  return verb == "pause" || verb == "resume" ? kTracker : kWithMap;
}

}  // namespace

CommandPort::CommandPort(service::ServiceContext& context, std::function<void()> notify)
    : next_id_(service::random_id()),
      results_(mailbox_, kMostAsked),
      commands_(topics::advertise(context.bus, topics::kCommand, topics::kViewer)),
      subscription_(topics::subscribe(context.bus, topics::kCommandResult, topics::kViewer,
                                      [this, notify = std::move(notify)](Result result) {
                                        results_.push(std::move(result));
                                        notify();
                                      })) {}

/// To one service where one is enough (a paused tracker makes nothing for the others), else to all.
void CommandPort::send(PageClient& page, const PageCommand& command) {
  const auto& services = services_for(command.verb);
  rds_msgs::msg::Command message;
  message.request_id(++next_id_);
  message.target(services.size() == 1 ? *services.begin() : "");
  message.verb(command.verb);
  message.argument(command.argument);
  asked_[next_id_] = {&page, command.verb};
  if (asked_.size() > kMostAsked) asked_.erase(asked_.begin());
  commands_.write(message);
}

void CommandPort::take() {
  while (const auto result = results_.try_pop()) {
    const auto asked = asked_.find((*result)->request_id());
    if (asked == asked_.end() || !services_for(asked->second.verb).contains((*result)->service())) continue;
    asked->second.page->reply(reply_frame(asked->second.verb, **result));
  }
}

void CommandPort::forget(const PageClient& page) {
  std::erase_if(asked_, [&](const auto& entry) { return entry.second.page == &page; });
}

}  // namespace rds::viewer
