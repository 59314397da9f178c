// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "bond/msg/Status.h"
#include "common/bus/participant.hpp"

namespace rds::service {

/// A node's end of a bond (package bond of ROS 2), by which a manager sees that the node lives: each
/// heartbeat of the manager is answered with one. So nothing is published unless a manager asks, and it hears
/// nothing any more when the process is gone or its worker hangs.
class Bond {
 public:
  static constexpr double kHeartbeatTimeoutS = 4;  // as Nav2's nodes have it

  /// @param id  of the bond: Nav2 takes the node's name. @param instance  of this process. @param lives
  /// whether the node is active, and its worker alive; asked on threads of the bus.
  Bond(bus::Participant& bus, std::string id, std::uint64_t instance, std::function<bool()> lives);

 private:
  void take(const bond::msg::Status& heartbeat);
  [[nodiscard]] std::optional<bool> answer_to(const bond::msg::Status& heartbeat);

  std::string id_;
  std::string instance_;
  std::function<bool()> lives_;
  std::mutex mutex_;
  std::string manager_;  // instance of who holds the other end; empty: nobody
  bus::Publisher<bond::msg::Status> publisher_;
  bus::Subscription subscription_;  // last: its callback uses the members above
};

}  // namespace rds::service
