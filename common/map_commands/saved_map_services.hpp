// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stop_token>
#include <thread>
#include <vector>

#include "common/bus/service_server.hpp"
#include "common/concurrency/mailbox.hpp"
#include "common/service/service.hpp"

namespace rds::map_commands {

/// `~/save_map` and `~/load_map` (rds_msgs/srv) of one node, for all services with a part of the map: what
/// `rds map save NAME` and `rds map load NAME` do.
///
/// A thread of its own commands the services and waits for them. One request is carried out at a time,
/// another one waits, more are answered "busy".
class SavedMapServices {
 public:
  /// Offers nothing in a secured domain. @throws bus::BusError
  explicit SavedMapServices(service::ServiceContext& context);

 private:
  using Job = std::function<void(const std::stop_token&)>;
  using Ask = service::CommandOutcome(bus::Participant& bus, const std::string& name,
                                      const std::stop_token& stop);

  template <class Request, class Response>
  bus::ServiceServer serve(bus::Participant& bus, const std::string& offered, Ask* ask);

  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Job> jobs_;
  std::jthread thread_;
  std::vector<bus::ServiceServer> services_;  // last: they fill the inbox
};

}  // namespace rds::map_commands
