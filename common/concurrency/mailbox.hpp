// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace rds::concurrency {

/// What one worker waits on: several inboxes, one condition.
class Mailbox {
 public:
  /// Waits until `ready()` holds; it is called under the lock, so it may use Inbox::locked_* only.
  /// @return false once stop is requested.
  template <class Ready>
  bool wait(const std::stop_token& stop, Ready ready) {
    std::unique_lock lock(mutex_);
    return changed_.wait(lock, stop, std::move(ready));
  }

  /// As wait(), for at most `limit`. @return whether `ready()` holds.
  template <class Ready>
  bool wait_for(const std::stop_token& stop, std::chrono::milliseconds limit, Ready ready) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, stop, limit, std::move(ready));
  }

 private:
  template <class T>
  friend class Inbox;

  std::mutex mutex_;
  std::condition_variable_any changed_;
};

/// First-in first-out queue of a mailbox: producers never wait, the worker pops.
///
/// When full, the oldest element is dropped and counted: for a live system the newest data matter most.
template <class T>
class Inbox {
 public:
  /// @param capacity  at least 1.
  Inbox(Mailbox& mailbox, std::size_t capacity) : mailbox_(mailbox), capacity_(capacity) {}

  void push(T value) {
    {
      const std::lock_guard lock(mailbox_.mutex_);
      if (queue_.size() >= capacity_) {
        queue_.pop_front();
        ++dropped_;
      }
      queue_.push_back(std::move(value));
    }
    mailbox_.changed_.notify_all();
  }

  /// As push(), but where it is full nothing changes. @return false then.
  bool try_push(T value) {
    {
      const std::lock_guard lock(mailbox_.mutex_);
      if (queue_.size() >= capacity_) return false;
      queue_.push_back(std::move(value));
    }
    mailbox_.changed_.notify_all();
    return true;
  }

  /// As push(), but where it is full it waits until the worker has made room: for work that must not be lost.
  void push_when_free(T value) {
    {
      std::unique_lock lock(mailbox_.mutex_);
      freed_.wait(lock, [this] { return queue_.size() < capacity_; });
      queue_.push_back(std::move(value));
    }
    mailbox_.changed_.notify_all();
  }

  std::optional<T> try_pop() {
    std::optional<T> front;
    {
      const std::lock_guard lock(mailbox_.mutex_);
      if (queue_.empty()) return std::nullopt;
      front.emplace(std::move(queue_.front()));
      queue_.pop_front();
    }
    freed_.notify_one();
    return front;
  }

  /// The newest element; the older ones stay.
  std::optional<T> try_pop_newest() {
    std::optional<T> newest;
    {
      const std::lock_guard lock(mailbox_.mutex_);
      if (queue_.empty()) return std::nullopt;
      newest.emplace(std::move(queue_.back()));
      queue_.pop_back();
    }
    freed_.notify_one();
    return newest;
  }

  /// For Mailbox::wait's condition only.
  [[nodiscard]] bool locked_empty() const { return queue_.empty(); }

  [[nodiscard]] std::size_t size() const {
    const std::lock_guard lock(mailbox_.mutex_);
    return queue_.size();
  }

  [[nodiscard]] std::uint64_t dropped() const {
    const std::lock_guard lock(mailbox_.mutex_);
    return dropped_;
  }

 private:
  Mailbox& mailbox_;
  std::condition_variable freed_;
  std::deque<T> queue_;
  std::size_t capacity_;
  std::uint64_t dropped_ = 0;
};

}  // namespace rds::concurrency
