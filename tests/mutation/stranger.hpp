// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/bus/participant.hpp"
#include "tests/mutation/message_mutation.hpp"

namespace rds::test {

/// Writes spoiled copies of what others have written on a topic.
class Stranger {
 public:
  virtual ~Stranger() = default;
  [[nodiscard]] virtual const std::string& topic() const = 0;
  /// @return false as long as there is nothing to spoil.
  [[nodiscard]] virtual bool is_ready() = 0;
  virtual void write() = 0;
  /// From now on it writes as this instance of a service, where a message names one.
  void speak_as(std::uint64_t instance) { instance_ = instance; }

 protected:
  std::optional<std::uint64_t> instance_;  // else that of the message that is copied
};

template <class Message>
class StrangerOf : public Stranger {
 public:
  /// @param own  a message to begin with, where nobody else writes.
  StrangerOf(bus::Participant& bus, std::string topic, const bus::Qos& qos, std::uint64_t seed)
      : topic_(std::move(topic)),
        mutation_(seed),
        publisher_(bus.advertise<Message>(topic_, qos)),
        subscription_(bus.subscribe<Message>(topic_, qos, [this](const auto& message) { keep(message); })) {}

  [[nodiscard]] const std::string& topic() const override { return topic_; }
  [[nodiscard]] bool is_ready() override {
    const std::lock_guard lock(mutex_);
    return !heard_.empty();
  }
  void write() override {
    Message message = pick();
    if constexpr (requires { message.instance(std::uint64_t{}); })
      message.instance(instance_.value_or(message.instance()));
    mutation_.spoil(message);
    publisher_.write(message);
  }

 private:
  static constexpr std::size_t kKept = 8;

  /// Only the first ones: later ones may be its own.
  void keep(const std::shared_ptr<const Message>& message) {
    const std::lock_guard lock(mutex_);
    if (heard_.size() < kKept) heard_.push_back(message);
  }
  Message pick() {
    const std::lock_guard lock(mutex_);
    return *heard_.at(mutation_.below(heard_.size()));
  }

  std::string topic_;
  std::mutex mutex_;
  std::deque<std::shared_ptr<const Message>> heard_;
  MessageMutation mutation_;
  bus::Publisher<Message> publisher_;
  bus::Subscription subscription_;  // last: its callback uses the members above
};

}  // namespace rds::test
