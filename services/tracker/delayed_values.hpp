// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace rds::tracker {

/// Answers of other threads and processes that were asked for at one frame and take effect at a later one.
///
/// In lockstep (`take_due`) an answer takes effect at the frame agreed on when it was asked for, and only
/// there the tracker waits for it (`complete`); in real time (`take_arrived`) it takes effect at once.
template <class T>
class DelayedValues {
 public:
  /// When kMaxWaiting questions wait, the oldest is given up and counted.
  void ask(std::uint64_t key, std::uint64_t due_frame) {
    waiting_.push_back({key, due_frame, std::nullopt});
    if (waiting_.size() <= kMaxWaiting) return;
    waiting_.pop_front();
    ++missed_;
  }

  /// @return false if nobody asked for the key (any more).
  bool arrive(std::uint64_t key, T value) {
    const auto entry =
        std::find_if(waiting_.begin(), waiting_.end(), [&](const Entry& e) { return e.key == key; });
    if (entry == waiting_.end()) return false;
    entry->value = std::move(value);
    return true;
  }

  /// An answer to this question and to all earlier ones (by key) that have none yet.
  void arrive_through(std::uint64_t key, const T& value) {
    for (Entry& entry : waiting_)
      if (entry.key <= key && !entry.value) entry.value = value;
  }

  /// Whether everything due at `frame` or before has arrived.
  [[nodiscard]] bool complete(std::uint64_t frame) const {
    return std::none_of(waiting_.begin(), waiting_.end(),
                        [&](const Entry& e) { return e.due_frame <= frame && !e.value; });
  }

  /// Takes what is due at `frame`, in the order it was asked for; what has not arrived is given up and
  /// counted.
  std::vector<T> take_due(std::uint64_t frame) {
    std::vector<T> due;
    while (!waiting_.empty() && waiting_.front().due_frame <= frame) take_front(due);
    return due;
  }

  /// Takes everything that has arrived, in the order it was asked for; older questions without an answer are
  /// given up.
  std::vector<T> take_arrived() {
    std::vector<T> arrived;
    const auto newest =
        std::find_if(waiting_.rbegin(), waiting_.rend(), [](const Entry& e) { return !!e.value; });
    for (auto left = waiting_.rend() - newest; left > 0; --left) take_front(arrived);
    return arrived;
  }

  void clear() { waiting_.clear(); }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  [[nodiscard]] std::size_t size() const { return waiting_.size(); }
  /// Answers that were given up so far.
  [[nodiscard]] std::size_t missed() const { return missed_; }

  static constexpr std::size_t kMaxWaiting = 1000;

 private:
  struct Entry {
    std::uint64_t key;
    std::uint64_t due_frame;
    std::optional<T> value;
  };

  void take_front(std::vector<T>& out) {
    if (waiting_.front().value)
      out.push_back(std::move(*waiting_.front().value));
    else
      ++missed_;
    waiting_.pop_front();
  }

  std::deque<Entry> waiting_;
  std::size_t missed_ = 0;
};

}  // namespace rds::tracker
