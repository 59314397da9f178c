// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>

#include "common/concurrency/mailbox.hpp"

namespace rds::mapper {

/// A thread that makes and writes messages, one after the other in the order in which they were handed over,
/// so that the worker does not wait for a large one. When kMaxWaiting of them wait, the worker does: no message
/// is lost and memory is bounded.
class Sender {
 public:
  Sender();

  /// What a message throws is logged; the next ones go out.
  void send(std::function<void()> message);
  /// Returns when all that was handed over is out.
  void flush();

  static constexpr std::size_t kMaxWaiting = 64;

 private:
  void run(const std::stop_token& stop);

  concurrency::Mailbox mailbox_;
  concurrency::Inbox<std::function<void()>> messages_;
  std::jthread thread_;  // last: it uses the members above, and sends what is left before it ends
};

}  // namespace rds::mapper
