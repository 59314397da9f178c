// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/bus/participant.hpp"
#include "common/service/presence.hpp"
#include "common/service/service.hpp"
#include "common/service/service_slot.hpp"
#include "rds_msgs/msg/Command.h"
#include "rds_msgs/msg/CommandResult.h"

namespace rds::service {

/// Listens on rds/command for one service, and answers every command on rds/command_result: what the worker
/// cannot take is answered, too (busy, stand-by).
///
/// `status` is answered at once, from the bus's thread, even while the worker is busy: a JSON object with the
/// service's name, version, instance, role, process id, the time since the worker was last alive, endpoints
/// (topic, direction, matched, messages, bytes, dropped) and figures.
class CommandServer {
 public:
  CommandServer(ServiceContext& context, const Presence& presence, ServiceSlot& service);

 private:
  void receive(const rds_msgs::msg::Command& command);
  void answer(std::uint64_t request_id, const CommandOutcome& outcome);
  [[nodiscard]] std::string status() const;

  ServiceContext& context_;
  const Presence& presence_;
  ServiceSlot& service_;
  bus::Publisher<rds_msgs::msg::CommandResult> results_;
  bus::Subscription subscription_;
};

}  // namespace rds::service
