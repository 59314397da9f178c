// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "common/bus/service_server.hpp"
#include "services/mapper/map_outputs.hpp"

namespace rds::mapper {

/// The map as it is when somebody asks, under the names of map_server and octomap_server: `~/map`
/// (nav_msgs/srv/GetMap), `octomap_binary` and `octomap_full` (octomap_msgs/srv/GetOctomap).
///
/// One answer is made at a time; kMaxWaiting requests wait, more are dropped.
class MapServices {
 public:
  /// @param mailbox  of the worker, who is woken by a request. @throws bus::BusError
  MapServices(service::ServiceContext& context, concurrency::Mailbox& mailbox, MapOutputs& outputs);

  /// Whether settle() has something to do; under the mailbox's lock.
  [[nodiscard]] bool locked_ready() const { return !asked_.locked_empty() && !outputs_.is_busy(); }
  /// Begins the next answer, on the worker, where none is under way.
  void settle(const SemanticMapper& mapper);

  static constexpr std::size_t kMaxWaiting = 8;

 private:
  using Asked = std::function<void(const SemanticMapper&)>;
  void ask(Asked asked);
  bus::ServiceServer octomap(bus::Participant& bus, const std::string& name, bool binary);

  MapOutputs& outputs_;
  concurrency::Inbox<Asked> asked_;
  std::vector<bus::ServiceServer> services_;  // last: they fill the inbox
};

}  // namespace rds::mapper
