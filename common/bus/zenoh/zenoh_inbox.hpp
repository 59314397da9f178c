// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <utility>

#include "common/bus/zenoh/zenoh_settings.hpp"

namespace rds::bus::detail {

/// The newest that have come (samples or requests) and were not taken yet: so many, and no more bytes than
/// one largest message has. Thread-safe.
/// @tparam Item  a pointer that owns.
template <class Item>
class ZenohInbox {
 public:
  explicit ZenohInbox(std::size_t depth) : depth_(depth) {}

  void push(Item item, std::size_t bytes) {
    std::deque<Waiting> displaced;  // ends without the lock
    {
      const std::lock_guard lock(mutex_);
      items_.push_back({std::move(item), bytes});
      bytes_ += bytes;
      while (items_.size() > depth_ || (bytes_ > kLargestMessage && items_.size() > 1)) {
        displaced.push_back(take_first());
        ++displaced_;
      }
    }
    changed_.notify_one();
  }
  /// @return null if there is none.
  Item pop() {
    const std::lock_guard lock(mutex_);
    return items_.empty() ? nullptr : take_first().item;
  }
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return woken_ || !items_.empty(); });
  }
  /// @return false if nothing has come meanwhile.
  bool wait_for(std::chrono::seconds limit) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, limit, [this] { return woken_ || !items_.empty(); });
  }
  void wake() {
    {
      const std::lock_guard lock(mutex_);
      woken_ = true;
    }
    changed_.notify_one();
  }
  /// How many went before they were taken.
  [[nodiscard]] std::uint64_t displaced() const { return displaced_; }

 private:
  struct Waiting {
    Item item;
    std::size_t bytes;
  };
  Waiting take_first() {
    Waiting first = std::move(items_.front());
    items_.pop_front();
    bytes_ -= first.bytes;
    return first;
  }

  std::size_t depth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> items_;
  std::size_t bytes_ = 0;  // of these
  bool woken_ = false;
  std::atomic<std::uint64_t> displaced_ = 0;
};

}  // namespace rds::bus::detail
