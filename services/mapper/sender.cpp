// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/sender.hpp"

#include <future>
#include <limits>

namespace rds::mapper {

Sender::Sender()
    : messages_(mailbox_, std::numeric_limits<std::size_t>::max()),
      thread_([this](const std::stop_token& stop) {
        while (mailbox_.wait(stop, [this] { return !messages_.locked_empty(); }))
          while (const auto message = messages_.try_pop()) (*message)();
      }) {}

void Sender::send(std::function<void()> message) {
  messages_.push(std::move(message));
}

void Sender::flush() {
  std::promise<void> sent;
  messages_.push([&sent] { sent.set_value(); });
  sent.get_future().wait();
}

}  // namespace rds::mapper
