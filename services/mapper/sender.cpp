// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/sender.hpp"

#include <future>

#include <spdlog/spdlog.h>

namespace rds::mapper {

Sender::Sender()
    : messages_(mailbox_, kMaxWaiting), thread_([this](const std::stop_token& stop) { run(stop); }) {}

void Sender::run(const std::stop_token& stop) {
  while (mailbox_.wait(stop, [this] { return !messages_.locked_empty(); }))
    while (const auto message = messages_.try_pop()) try {
        (*message)();
      } catch (const std::exception& e) {
        spdlog::error("a message could not be made: {}", e.what());
      }
}

void Sender::send(std::function<void()> message) {
  messages_.push_when_free(std::move(message));
}

void Sender::flush() {
  std::promise<void> sent;
  send([&sent] { sent.set_value(); });
  sent.get_future().wait();
}

}  // namespace rds::mapper
