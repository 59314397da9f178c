// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include <tl/expected.hpp>

#include "common/bus/participant.hpp"
#include "common/messages/registry.hpp"

namespace rds::tools {

using Clock = std::chrono::steady_clock;

/// A message of a type learnt at run time, and when it came.
struct Arrival {
  std::shared_ptr<const void> message;
  std::size_t bytes = 0;  // on the wire
  Clock::time_point time;
};

/// Reads a topic whose type, reliability and durability are whatever its publisher offers.
class TopicReader {
 public:
  /// Waits until somebody announces the topic, then subscribes with the strongest QoS that a publisher
  /// matches: reliable with history, reliable, best effort.
  ///
  /// @param keep_messages  false: only size and time are kept.
  /// @return or one sentence: nobody there by the deadline, a type no IDL file of this program defines,
  /// stopped.
  static tl::expected<std::unique_ptr<TopicReader>, std::string> open(bus::Participant& participant,
                                                                      const std::string& topic,
                                                                      bool keep_messages,
                                                                      Clock::time_point deadline,
                                                                      const std::stop_token& stop);

  /// The next message; nullopt at the deadline or when stop is requested.
  std::optional<Arrival> next(Clock::time_point deadline, const std::stop_token& stop);

  [[nodiscard]] const messages::MessageType& type() const { return *type_; }
  /// Messages that came faster than they were taken.
  [[nodiscard]] std::size_t dropped() const;

 private:
  TopicReader(const messages::MessageType& type, bool keep_messages)
      : type_(&type), keep_messages_(keep_messages) {}
  void subscribe(bus::Participant& participant, const std::string& topic, const std::stop_token& stop);
  void push(std::shared_ptr<const void> message);

  const messages::MessageType* type_;
  bool keep_messages_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Arrival> arrivals_;
  std::size_t dropped_ = 0;
  std::unique_ptr<bus::detail::SubscriptionEndpoint> subscription_;  // last: its callback uses the others
};

}  // namespace rds::tools
