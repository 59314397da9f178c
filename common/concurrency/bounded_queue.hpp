// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace rds::concurrency {

/// First-in first-out queue between a producer that never waits and one consumer that does.
///
/// When full, the oldest element is dropped and counted: for a live system the newest data matter most.
template <class T>
class BoundedQueue {
 public:
  /// @param capacity  at least 1.
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

  void push(T value) {
    {
      const std::lock_guard lock(mutex_);
      if (queue_.size() >= capacity_) {
        queue_.pop_front();
        ++dropped_;
      }
      queue_.push_back(std::move(value));
    }
    not_empty_.notify_one();
  }

  /// Waits for an element; nullopt once stop is requested.
  std::optional<T> pop(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    if (!not_empty_.wait(lock, stop, [this] { return !queue_.empty(); })) return std::nullopt;
    return take_front();
  }

  std::optional<T> try_pop() {
    const std::lock_guard lock(mutex_);
    if (queue_.empty()) return std::nullopt;
    return take_front();
  }

  [[nodiscard]] std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return queue_.size();
  }

  [[nodiscard]] std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  T take_front() {
    T front = std::move(queue_.front());
    queue_.pop_front();
    return front;
  }

  mutable std::mutex mutex_;
  std::condition_variable_any not_empty_;
  std::deque<T> queue_;
  std::size_t capacity_;
  std::uint64_t dropped_ = 0;
};

}  // namespace rds::concurrency
