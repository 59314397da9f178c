// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include <spdlog/sinks/base_sink.h>

#include "common/bus/participant.hpp"
#include "common/concurrency/mailbox.hpp"
#include "rcl_interfaces/msg/Log.h"

namespace rds::service {

/// Says on `/rosout`, as nodes of rclcpp do, what is logged.
///
/// Whoever logs never waits for the bus: a thread of its own writes; the kMostWaiting newest lines wait for
/// it, older ones are left out. What this thread itself logs is not said.
class Rosout : public spdlog::sinks::base_sink<std::mutex> {
 public:
  static constexpr std::size_t kMostWaiting = 256;

  /// @param name  of the node as a logger: "robot1.rds_tracker". @throws bus::BusError
  Rosout(bus::Participant& bus, std::string name);
  /// Writes what waits.
  ~Rosout() override;

 protected:
  void sink_it_(const spdlog::details::log_msg& line) override;
  void flush_() override {}

 private:
  using Log = rcl_interfaces::msg::Log;
  void write(const std::stop_token& stop);

  std::string name_;
  bus::Publisher<Log> publisher_;
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<Log> lines_;
  std::jthread thread_;  // last: it uses the members above
};

}  // namespace rds::service
