// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>

#include "common/concurrency/mailbox.hpp"

namespace rds::mapper {

/// A thread that makes and writes messages, one after the other in the order in which they were handed over,
/// so that the worker never waits for a large one.
class Sender {
 public:
  Sender();

  void send(std::function<void()> message);
  /// Returns when all that was handed over is out.
  void flush();

 private:
  concurrency::Mailbox mailbox_;
  concurrency::Inbox<std::function<void()>> messages_;
  std::jthread thread_;  // last: it uses the members above, and sends what is left before it ends
};

}  // namespace rds::mapper
