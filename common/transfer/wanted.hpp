// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>

#include "common/transfer/transfer.hpp"

namespace rds::transfer {

/// Which items of a stream a reader lacks.
class Wanted {
 public:
  /// What was offered before and is no more is not wanted any longer. @return how many these are
  std::size_t offer(const Offer& offer) {
    if (offer.oldest > offer.newest || offer.newest == std::numeric_limits<std::uint64_t>::max()) return 0;
    const std::size_t before = missing_.size();
    missing_.erase(missing_.begin(), missing_.lower_bound(offer.oldest));
    const std::size_t given_up = before - missing_.size();
    const std::uint64_t reach = offer.newest - std::min(offer.newest, kMost - 1);
    for (std::uint64_t n = std::max({offer.oldest, next_, reach}); n <= offer.newest; ++n) missing_.insert(n);
    next_ = std::max(next_, offer.newest + 1);
    return given_up;
  }
  /// The reader has it, or nobody does.
  void remove(std::uint64_t number) { missing_.erase(number); }
  /// By number.
  [[nodiscard]] const std::set<std::uint64_t>& missing() const { return missing_; }

 private:
  static constexpr std::uint64_t kMost = 100'000;  // of an offer; three hours of ten keyframes a second

  std::uint64_t next_ = 0;  // after the newest that was offered
  std::set<std::uint64_t> missing_;
};

}  // namespace rds::transfer
