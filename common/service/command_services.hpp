// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/bus/service_server.hpp"
#include "common/service/service_slot.hpp"

namespace rds::service {

/// What a node of ROS 2 may ask of one service, beside rds/command: `~/reset` (std_srvs/srv/Trigger),
/// `~/pause` (SetBool: true pauses, false resumes), carried out and answered by the worker.
class CommandServices {
 public:
  /// @throws bus::BusError
  CommandServices(ServiceContext& context, ServiceSlot& service);

 private:
  /// @param respond  is told the outcome, once, on any thread.
  void post(const std::string& verb, std::function<void(const CommandOutcome&)> respond);

  ServiceSlot& service_;
  bus::ServiceServer reset_;
  bus::ServiceServer pause_;
};

/// Whether services of ROS 2 are offered: not in a secured domain, whose permissions name
/// topics alone.
bool offers_services(const bus::ParticipantOptions& participant);

}  // namespace rds::service
