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

/// How many items a reader lacks, told by one thread and read by others.
class Backlog {
 public:
  void set(std::size_t items, Time now) {
    items_ = items;
    if (items == 0) none_at_ = now;
  }
  [[nodiscard]] std::size_t items() const { return items_; }
  /// The items, if some have been lacking for longer than a link takes that carries them all.
  [[nodiscard]] std::optional<std::size_t> behind(Time now) const {
    const std::size_t items = items_;
    if (items == 0 || now - none_at_.load() < kLong) return std::nullopt;
    return items;
  }

 private:
  static constexpr std::chrono::milliseconds kLong{1500};

  std::atomic<std::size_t> items_ = 0;
  std::atomic<Time> none_at_{};
};

}  // namespace rds::transfer
