// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <thread>

#include "common/service/presence.hpp"
#include "common/service/service_slot.hpp"
#include "common/service/version_watch.hpp"
#include "diagnostic_msgs/msg/DiagnosticArray.h"

namespace rds::service {

/// Publishes a process's figures on `diagnostics` and its state on `rds/services` once a second, from a
/// thread of its own; how the service is, is what its worker shows.
class DiagnosticsPublisher {
 public:
  DiagnosticsPublisher(ServiceContext& context, Presence& presence, const ServiceSlot& service);

 private:
  void publish();
  Health health(const WorkerState& worker, std::size_t mismatches);

  ServiceContext& context_;
  Presence& presence_;
  const ServiceSlot& service_;
  bus::Publisher<diagnostic_msgs::msg::DiagnosticArray> publisher_;
  VersionWatch versions_;
  std::uint64_t troubles_before_ = 0;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::service
