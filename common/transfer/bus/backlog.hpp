// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

inline Time now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// How many items a reader lacks for ever, told by one thread and read by others.
class GivenUp {
 public:
  void set(std::uint64_t items, Time now) {
    if (items > items_) grown_at_ = now;
    items_ = items;
  }
  [[nodiscard]] std::uint64_t items() const { return items_; }
  /// The items, if they have become more of late.
  [[nodiscard]] std::optional<std::uint64_t> lately(Time now) const {
    const std::uint64_t items = items_;
    if (items == 0 || now - grown_at_.load() > kLately) return std::nullopt;
    return items;
  }

 private:
  static constexpr std::chrono::seconds kLately{10};

  std::atomic<std::uint64_t> items_ = 0;
  std::atomic<Time> grown_at_{};
};

/// How many items a reader lacks that should be there, told by one thread and read by others.
class Backlog {
 public:
  void set(std::size_t items, Time now) {
    items_ = items;
    told_at_ = now;
  }
  [[nodiscard]] std::size_t items() const { return items_; }
  /// The items, if there are any, and the reader still says so: it does each second.
  [[nodiscard]] std::optional<std::size_t> behind(Time now) const {
    const std::size_t items = items_;
    if (items == 0 || now - told_at_.load() > kSilent) return std::nullopt;
    return items;
  }

 private:
  static constexpr std::chrono::seconds kSilent{3};

  std::atomic<std::size_t> items_ = 0;
  std::atomic<Time> told_at_{};
};

}  // namespace rds::transfer
