// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <stop_token>
#include <utility>

#include "common/messages/serialized.hpp"

namespace rds::record {

/// A message that waits to be written.
struct Received {
  std::size_t topic = 0;  // number
  std::int64_t time_ns = 0;
  std::shared_ptr<const messages::SerializedMessage> message;
};

/// First-in first-out, bounded by the messages' bytes: the bus never waits for the disk.
class MessageQueue {
 public:
  explicit MessageQueue(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// @return false if it is full: the message is dropped.
  bool push(Received received) {
    const std::size_t size = received.message->bytes.size();
    {
      const std::lock_guard lock(mutex_);
      if (bytes_ + size > most_bytes_ && bytes_ > 0) return false;
      bytes_ += size;
      waiting_.push_back(std::move(received));
    }
    changed_.notify_one();
    return true;
  }

  /// All that waits, at the latest after `limit`, when stop is requested at once.
  std::deque<Received> take_all(const std::stop_token& stop, std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, stop, limit, [this] { return !waiting_.empty(); });
    bytes_ = 0;
    return std::exchange(waiting_, {});
  }

 private:
  std::size_t most_bytes_;
  std::mutex mutex_;  // of what follows
  std::condition_variable_any changed_;
  std::deque<Received> waiting_;
  std::size_t bytes_ = 0;
};

}  // namespace rds::record
