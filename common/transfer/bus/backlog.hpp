// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

inline Time now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

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
