// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <thread>

#include "common/service/peers/peer_watch.hpp"
#include "common/service/presence.hpp"
#include "common/service/service_slot.hpp"
#include "common/service/version_watch.hpp"
#include "diagnostic_msgs/msg/DiagnosticArray.h"

namespace rds::service {

/// Publishes a process's figures on `diagnostics` and its state on `rds/services` once a second, from a
/// thread of its own; how the service is, is what its worker shows. Looks at the others four times as often,
/// and logs at once what begins to be wrong. What supervises the process (systemd) hears that it is alive
/// only while the worker is.
class DiagnosticsPublisher {
 public:
  DiagnosticsPublisher(ServiceContext& context, Presence& presence, const ServiceSlot& service);

  /// Ends the reports with a last one, of all that was counted; once, at the end of the process.
  void finish();

  /// Since the last report [s]; any thread. Much more than a second if the bus hangs.
  [[nodiscard]] double silent_s() const;

 private:
  void look();
  void publish();
  Health health(const WorkerState& worker, std::size_t mismatches);
  void tell_supervisor(const WorkerState& worker, const Health& health);

  ServiceContext& context_;
  Presence& presence_;
  const ServiceSlot& service_;
  bus::Publisher<diagnostic_msgs::msg::DiagnosticArray> publisher_;
  VersionWatch versions_;
  PeerWatch others_;
  std::map<std::string, std::string> warnings_;  // by name
  std::uint64_t troubles_before_ = 0;
  std::string told_;  // to the supervisor
  std::atomic<std::chrono::steady_clock::time_point> published_ = std::chrono::steady_clock::now();
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::service
